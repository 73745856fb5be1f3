#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/fuzz/mutators.h"

namespace opaline::fuzz {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kHead = 12, kChunkHead = 8;
constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBin = 0x004e4942;

std::uint32_t word_at(const Blob& bytes, std::size_t at) {
    std::uint32_t word = 0;
    if (at + 4 <= bytes.size()) std::memcpy(&word, bytes.data() + at, 4);
    return word;
}

void append(Blob& bytes, std::initializer_list<std::uint32_t> words) {
    for (const std::uint32_t word : words) {
        const auto* first = reinterpret_cast<const std::uint8_t*>(&word);
        bytes.insert(bytes.end(), first, first + 4);
    }
}

Blob make_glb(std::string json, const Blob& bin) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    Blob bytes;
    append(bytes, {kMagic, 2, 0, static_cast<std::uint32_t>(json.size()), kJson});
    bytes.insert(bytes.end(), json.begin(), json.end());
    if (!bin.empty()) {
        append(bytes, {static_cast<std::uint32_t>((bin.size() + 3) / 4 * 4), kBin});
        bytes.insert(bytes.end(), bin.begin(), bin.end());
        bytes.resize((bytes.size() + 3) / 4 * 4);
    }
    const auto size = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(bytes.data() + 8, &size, 4);
    return bytes;
}

// Values at which readers go wrong.
Json odd_value(std::minstd_rand& random) {
    const Json values[] = {0u,
                           1u,
                           2u,
                           3u,
                           4u,
                           255u,
                           65535u,
                           65536u,
                           2147483647u,
                           4294967295u,
                           1ull << 40,
                           -1,
                           0.5,
                           -1e30,
                           1e300,
                           1e-45,
                           nullptr,
                           "",
                           "x",
                           true,
                           Json::array(),
                           Json::object()};
    const Json types[] = {5120u,  5121u,  5123u,  5125u,  5126u,  "SCALAR",
                          "VEC2", "VEC3", "VEC4", "MAT4", "MASK", "BLEND"};
    return random() % 4 != 0 ? values[random() % std::size(values)]
                             : types[random() % std::size(types)];
}

// All values below `root`, itself not among them.
void list_values(Json& root, std::vector<Json*>& all) {
    for (Json& value : root) {
        all.push_back(&value);
        if (value.is_structured()) list_values(value, all);
    }
}

void change_value(Json& root, std::minstd_rand& random) {
    std::vector<Json*> all;
    if (root.is_structured()) list_values(root, all);
    if (all.empty()) return;
    Json& chosen = *all[random() % all.size()];
    const Json other = *all[random() % all.size()];
    switch (random() % 6) {
        case 0:
            chosen = other;
            break;
        case 1:
            if (chosen.is_array()) chosen.push_back(other);
            break;
        case 2:
            if (chosen.is_structured() && !chosen.empty()) {
                auto at = chosen.begin();
                std::advance(at, random() % chosen.size());
                chosen.erase(at);
            }
            break;
        case 3:
            if (chosen.is_number()) chosen = chosen.get<double>() * (random() % 2 == 0 ? 2 : -0.5);
            break;
        case 4:
            if (chosen.is_number_integer()) {
                chosen = chosen.get<std::int64_t>() + static_cast<int>(random() % 9) - 4;
            }
            break;
        default:
            chosen = odd_value(random);
    }
}

}  // namespace

std::string mutate_json(const std::string& text, unsigned seed, std::size_t most) {
    std::minstd_rand random(seed);
    Json root = Json::parse(text, nullptr, false);
    std::string changed;
    if (root.is_discarded() || random() % 8 == 0) {
        const Blob bytes = mutate_bytes(Blob(text.begin(), text.end()), most);
        changed.assign(bytes.begin(), bytes.end());
    } else {
        for (unsigned i = 0; i <= random() % 2; ++i) {
            change_value(root, random);
        }
        changed = root.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    return changed.size() <= most ? changed : text;
}

Blob mutate_glb(const Blob& bytes, unsigned seed, std::size_t most) {
    std::minstd_rand random(seed);
    const std::size_t json_size = word_at(bytes, kHead), json_at = kHead + kChunkHead;
    const bool is_glb = word_at(bytes, 0) == kMagic && json_size <= bytes.size() - json_at;
    if (!is_glb || random() % 32 == 0) return mutate_bytes(bytes, most);
    const auto at = [&](std::size_t i) { return bytes.begin() + static_cast<std::ptrdiff_t>(i); };
    std::string json(at(json_at), at(json_at + json_size));
    json.resize(json.find_last_not_of(' ') + 1);
    const std::size_t bin_at = std::min(json_at + json_size + kChunkHead, bytes.size());
    Blob bin(at(bin_at), bytes.end());
    if (random() % 4 != 0 || bin.empty()) {
        json = mutate_json(json, static_cast<unsigned>(random()), most);
    } else {
        const std::size_t size = bin.size();
        bin = mutate_bytes(bin, size);
        bin.resize(size);
    }
    Blob made = make_glb(std::move(json), bin);
    return made.size() <= most ? made : Blob();
}

}  // namespace opaline::fuzz
