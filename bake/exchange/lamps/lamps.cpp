#include "bake/exchange/lamps/lamps.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "bake/scene/base_color.h"
#include "formats/opal/emitters.h"

namespace opaline::bake {
namespace {

// "Vase" of "node 'Vase' > mesh 3 > primitive 0", "node 5" of one without a name.
std::string node_name(const formats::Primitive& primitive) {
    std::string name = primitive.name.substr(0, primitive.name.find(" > "));
    const std::size_t first = name.find('\''), last = name.rfind('\'');
    if (first != std::string::npos && last > first + 1) {
        name = name.substr(first + 1, last - first - 1);
    }
    return name.empty() ? "node " + std::to_string(primitive.node) : name;
}

// As a file takes it: without control characters, cut at a whole UTF-8 character.
std::string clean_name(std::string name, std::size_t most) {
    std::ranges::replace_if(
        name, [](char c) { return c >= 0 && c < ' '; }, ' ');
    if (name.size() > most) {
        while (most > 0 && (static_cast<unsigned char>(name[most]) & 0xc0u) == 0x80u)
            --most;
        name.resize(most);
    }
    return name;
}

bool is_taken(const std::vector<Lamp>& lamps, std::string_view name) {
    return std::ranges::any_of(lamps, [&](const Lamp& lamp) { return lamp.name == name; });
}

Lamp& add_lamp(std::vector<Lamp>& lamps, const std::string& wanted) {
    return lamps.emplace_back(Lamp{.name = free_emitter_name(wanted, names_of(lamps))});
}

std::vector<Lamp> list_ungrouped_lamps(const formats::Scene& scene) {
    std::vector<Lamp> lamps;
    std::uint32_t node = formats::kNone;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const formats::Primitive& primitive = scene.primitives[p];
        if (primitive.index.empty() || !is_emissive(scene.materials[primitive.material])) continue;
        // Primitives of a node stand together.
        if (lamps.empty() || primitive.node != node) add_lamp(lamps, node_name(primitive));
        node = primitive.node;
        lamps.back().primitives.push_back(p);
    }
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
        const formats::Light& light = scene.lights[i];
        if (light.intensity == formats::Rgb{}) continue;
        add_lamp(lamps, light.name.empty() ? "light " + std::to_string(i) : light.name)
            .lights.push_back(i);
    }
    return lamps;
}

using GroupOf = std::map<std::string_view, const formats::EmitterGroup*>;  // by member

GroupOf group_members(const formats::Scene& scene) {
    GroupOf group_of;
    for (const formats::EmitterGroup& group : scene.emitter_groups) {
        for (const std::string& member : group.members)
            group_of.emplace(member, &group);
    }
    return group_of;
}

formats::Error group_error(const formats::Scene& scene, const std::string& group, std::string fault,
                           std::string remedy) {
    return formats::make_error(formats::ErrorKind::bad_input, scene.source,
                               "media > emitters > " + group, std::move(fault), std::move(remedy));
}

std::string list_names(const std::vector<Lamp>& lamps) {
    constexpr std::size_t kShown = 12;
    std::string names;
    for (std::size_t i = 0; i < std::min(lamps.size(), kShown); ++i) {
        names += (i == 0 ? "'" : ", '") + lamps[i].name + "'";
    }
    return lamps.empty() ? "none" : lamps.size() > kShown ? names + ", ..." : names;
}

formats::Status check_groups(const formats::Scene& scene) {
    const std::vector<Lamp> lamps = list_ungrouped_lamps(scene);
    const GroupOf group_of = group_members(scene);
    for (const formats::EmitterGroup& group : scene.emitter_groups) {
        for (const std::string& member : group.members) {
            if (!is_taken(lamps, member)) {
                return group_error(scene, group.name, "there is no emitter '" + member + "'",
                                   "the scene has: " + list_names(lamps));
            }
        }
        if (is_taken(lamps, group.name) && !group_of.contains(group.name)) {
            return group_error(scene, group.name, "an emitter outside has this name already",
                               "give the group another name, or put that emitter into a group");
        }
    }
    return formats::ok_status();
}

}  // namespace

std::vector<std::string> names_of(std::span<const Lamp> lamps) {
    std::vector<std::string> names;
    for (const Lamp& lamp : lamps) {
        names.push_back(lamp.name);
    }
    return names;
}

std::string free_emitter_name(const std::string& wanted, std::span<const std::string> taken) {
    constexpr std::size_t kSuffix = 16;
    const std::string base = clean_name(wanted, formats::kMaxEmitterName - kSuffix);
    std::string name = base;
    for (int i = 2; std::ranges::count(taken, name) > 0; ++i) {
        name = base + " (" + std::to_string(i) + ")";
    }
    return name;
}

std::vector<Lamp> list_lamps(const formats::Scene& scene) {
    const GroupOf group_of = group_members(scene);
    std::vector<Lamp> lamps;
    for (Lamp& lamp : list_ungrouped_lamps(scene)) {
        const auto found = group_of.find(lamp.name);
        if (found == group_of.end()) {
            lamps.push_back(std::move(lamp));
            continue;
        }
        auto group = std::ranges::find(lamps, found->second->name, &Lamp::name);
        if (group == lamps.end()) {
            group = lamps.insert(lamps.end(), Lamp{.name = found->second->name});
        }
        const auto append = [](const auto& from, auto& to) {
            to.insert(to.end(), from.begin(), from.end());
        };
        append(lamp.primitives, group->primitives);
        append(lamp.lights, group->lights);
    }
    return lamps;
}

std::size_t count_emitters(std::span<const Lamp> lamps, std::size_t glowing) {
    const auto lit = std::ranges::count_if(
        lamps, [](const Lamp& lamp) { return lamp.volume != formats::kNone; });
    return lamps.size() + glowing - static_cast<std::size_t>(lit);
}

formats::Status check_lamps(const formats::Scene& scene, std::size_t lamps,
                            std::string_view effect) {
    if (auto status = check_groups(scene); !status) return status;
    if (lamps <= formats::kMaxEmitters) return formats::ok_status();
    return formats::make_error(formats::ErrorKind::bad_input, scene.source, std::string(effect),
                               std::to_string(lamps) +
                                   " nodes and lights send out light; a file holds " +
                                   std::to_string(formats::kMaxEmitters) + " emitters at most",
                               "group those that are switched together (\"emitters\" of a media "
                               "file), or leave emitters out "
                               "with --effects");
}

}  // namespace opaline::bake
