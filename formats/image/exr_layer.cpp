#include "formats/image/exr_layer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace opaline::formats {
namespace {

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

std::string layer_of(std::string_view channel) {
    const std::size_t dot = channel.rfind('.');
    return std::string(channel.substr(0, dot == std::string_view::npos ? 0 : dot));
}

std::string_view last_name(std::string_view channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string_view::npos ? channel : channel.substr(dot + 1);
}

/// The channel of `layer` that is called one of `names`.
std::optional<std::string> find_channel(const std::vector<std::string>& channels,
                                        std::string_view layer,
                                        std::initializer_list<std::string_view> names) {
    for (const std::string& channel : channels) {
        if (layer_of(channel) != layer) continue;
        const std::string last = lower(last_name(channel));
        if (std::find(names.begin(), names.end(), last) != names.end()) return channel;
    }
    return std::nullopt;
}

/// A layer and its rank: 0 colours, 1 grey, 2 some of the colours, 3 nothing that we read.
struct Candidate {
    ExrLayer layer;
    int rank = 3;
};

Candidate rank_layer(const ExrHeader& header, std::size_t part, std::string name) {
    const std::vector<std::string>& full = header.full_size;
    Candidate result;
    ExrLayer& layer = result.layer;
    layer.part = part;
    layer.red = find_channel(full, name, {"r", "red"});
    layer.green = find_channel(full, name, {"g", "green"});
    layer.blue = find_channel(full, name, {"b", "blue"});
    layer.name = std::move(name);
    const auto luminance = find_channel(full, layer.name, {"y"});
    const bool is_vector = find_channel(full, layer.name, {"x", "z"}).has_value();
    const bool has_chroma = find_channel(header.subsampled, layer.name, {"ry", "by"}).has_value();
    if (layer.red && layer.green && layer.blue) {
        result.rank = 0;
    } else if (layer.name.empty() && (layer.red || layer.green || layer.blue)) {
        result.rank = 2;
    } else if (luminance && !is_vector && !has_chroma) {
        layer.red = luminance;
        layer.is_grey = true;
        result.rank = 1;
    }
    return result;
}

/// The layers of a part, those that renderers mean as the whole picture first.
std::vector<std::string> list_layers(const ExrHeader& header) {
    std::vector<std::string> layers;
    for (const std::string& channel : header.full_size) {
        std::string layer = layer_of(channel);
        if (std::find(layers.begin(), layers.end(), layer) == layers.end()) {
            layers.push_back(std::move(layer));
        }
    }
    const auto order = [](const std::string& layer) {
        constexpr std::array<std::string_view, 3> whole{"combined", "beauty", "rgba"};
        const std::string last = lower(last_name(layer));
        if (layer.empty()) return 0;
        return std::find(whole.begin(), whole.end(), last) != whole.end() ? 1 : 2;
    };
    std::stable_sort(layers.begin(), layers.end(), [&](const std::string& a, const std::string& b) {
        return order(a) < order(b);
    });
    return layers;
}

std::vector<Candidate> list_candidates(std::span<const ExrHeader> parts) {
    std::vector<Candidate> candidates;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        if (parts[part].is_deep) continue;
        for (const std::string& layer : list_layers(parts[part])) {
            candidates.push_back(rank_layer(parts[part], part, layer));
        }
    }
    return candidates;
}

}  // namespace

std::optional<ExrLayer> choose_layer(std::span<const ExrHeader> parts) {
    const std::vector<Candidate> candidates = list_candidates(parts);
    const auto best =
        std::min_element(candidates.begin(), candidates.end(),
                         [](const Candidate& a, const Candidate& b) { return a.rank < b.rank; });
    if (best == candidates.end() || best->rank == 3) return std::nullopt;
    return best->layer;
}

std::size_t count_color_layers(std::span<const ExrHeader> parts) {
    const std::vector<Candidate> candidates = list_candidates(parts);
    return static_cast<std::size_t>(std::count_if(candidates.begin(), candidates.end(),
                                                  [](const Candidate& c) { return c.rank == 0; }));
}

}  // namespace opaline::formats
