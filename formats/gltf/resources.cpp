#include "formats/gltf/resources.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

namespace {

using Json = nlohmann::json;

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::optional<std::string> percent_decode(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
        if (high < 0 || low < 0) return std::nullopt;
        decoded += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return decoded;
}

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;  // '-' and '_' are the URL-safe alphabet
    if (c == '/' || c == '_') return 63;
    return -1;
}

std::optional<std::vector<std::byte>> decode_base64(std::string_view text) {
    while (text.ends_with('=')) {
        text.remove_suffix(1);
    }
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int digit = base64_digit(c);
        if (digit < 0) return std::nullopt;
        bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xffffffu;
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes.push_back(static_cast<std::byte>(bits >> held & 0xffu));
        }
    }
    return bytes;
}

bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    const std::size_t slash = uri.find('/');
    return colon != std::string_view::npos && (slash == std::string_view::npos || colon < slash);
}

std::optional<Bytes> read_data_uri(Resources& resources, std::string_view uri,
                                   const std::string& where, Report& report) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
        return report.fail(where, "its data URI is not base64",
                           "store the data as base64 or in a file");
    }
    auto bytes = decode_base64(uri.substr(comma + 1));
    if (!bytes) return report.fail(where, "its data URI holds characters that are not base64");
    return resources.keep(std::move(*bytes));
}

constexpr const char* kKeepInside =
    "keep what a file refers to in its folder, or allow another folder with --allow-path DIR";

/// Whether `file`, canonical, lies in `folder` after its own links.
bool is_within(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code code;
    const auto base = std::filesystem::canonical(folder.empty() ? "." : folder, code);
    const auto [end, unused] = std::mismatch(base.begin(), base.end(), file.begin(), file.end());
    return !code && end == base.end();
}

/// `name` as a path below the asset's folder, or an absolute one, if it may be opened.
std::optional<std::filesystem::path> confined_path(const Resources& resources,
                                                   std::string_view name, const std::string& where,
                                                   Report& report) {
    if (name.empty() || name.find('\0') != std::string_view::npos || name.size() > 4096) {
        return report.fail(where, "its URI " + in_quotes(name) + " is malformed", kKeepInside);
    }
    const std::filesystem::path path(name);
    std::error_code code;
    const auto file = std::filesystem::weakly_canonical(
        (resources.folder.empty() ? std::filesystem::path(".") : resources.folder) / path, code);
    const bool is_allowed =
        !code && !has_scheme(name) && name.find('\\') == std::string_view::npos &&
        (is_within(resources.folder, file) ||
         std::any_of(resources.allowed.begin(), resources.allowed.end(),
                     [&](const std::filesystem::path& folder) { return is_within(folder, file); }));
    if (!is_allowed) {
        return report.fail(where, "its URI " + in_quotes(name) + " leaves the asset's folder",
                           kKeepInside);
    }
    return path;
}

bool is_meshopt_placeholder(const Json& buffer) {
    const Json* meshopt = find_extension(buffer, "EXT_meshopt_compression");
    const Json* fallback = meshopt ? find_member(*meshopt, "fallback") : nullptr;
    return fallback && *fallback == true;
}

}  // namespace

Bytes Resources::keep(std::vector<std::byte> bytes) {
    bytes_held += bytes.size();
    storage.push_back(std::move(bytes));
    return storage.back();
}

std::optional<Bytes> read_inside(Resources& resources, std::string_view name,
                                 const std::string& where, Report& report) {
    const auto confined = confined_path(resources, name, where, report);
    if (!confined) return std::nullopt;
    const auto path = resources.folder / *confined;
    std::error_code code;
    const auto key = std::filesystem::weakly_canonical(path, code);
    if (const auto known = resources.files.find(key); known != resources.files.end()) {
        return known->second;
    }
    auto bytes = read_whole_file(path, where + " (" + in_quotes(confined->string()) + ")", report);
    if (!bytes) return std::nullopt;
    if (resources.bytes_held + bytes->size() > kMaxTotalBytes) {
        report.over_limit(
            where, "the asset's files together pass " + std::to_string(kMaxTotalBytes) + " bytes",
            "split the asset");
        return std::nullopt;
    }
    const Bytes kept = resources.keep(std::move(*bytes));
    resources.hash.add(kept);
    resources.inputs.push_back(path);
    resources.files.emplace(key, kept);
    return kept;
}

std::optional<Bytes> read_uri(Resources& resources, std::string_view uri, const std::string& where,
                              Report& report) {
    if (uri.starts_with("data:")) return read_data_uri(resources, uri, where, report);
    const auto name = percent_decode(uri);
    if (!name) {
        return report.fail(where, "its URI " + in_quotes(uri) + " is malformed", kKeepInside);
    }
    return read_inside(resources, *name, where, report);
}

void load_buffers(const nlohmann::json& root, const Container& container, Resources& resources,
                  Report& report) {
    const auto buffers = root.find("buffers");
    if (buffers == root.end()) return;
    for (std::size_t i = 0; i < buffers->size(); ++i) {
        const Json& buffer = (*buffers)[i];
        const std::string where = "buffer " + std::to_string(i);
        const auto length = buffer.find("byteLength");
        const auto uri = buffer.find("uri");
        std::optional<Bytes> bytes;
        if (length == buffer.end()) {
            report.error(where, "byteLength is missing");
        } else if (uri != buffer.end() && uri->is_string()) {
            bytes = read_uri(resources, uri->get_ref<const std::string&>(), where, report);
        } else if (uri != buffer.end()) {
            report.error(where, "its uri is not a string");
        } else if (is_meshopt_placeholder(buffer)) {
            bytes.emplace();
            resources.buffers.push_back(*bytes);
            continue;
        } else if (i == 0 && container.bin) {
            bytes = container.bin;
        } else {
            report.error(where, "it has no uri and there is no binary chunk for it");
        }
        if (bytes && bytes->size() < length->get<std::uint64_t>()) {
            report.error(where,
                         "it has " + std::to_string(bytes->size()) + " bytes, but byteLength is " +
                             std::to_string(length->get<std::uint64_t>()),
                         "the data is cut off: copy or export it again");
            bytes.reset();
        }
        resources.buffers.push_back(bytes ? bytes->first(length->get<std::uint64_t>()) : Bytes{});
    }
}

}  // namespace opaline::formats::gltf
