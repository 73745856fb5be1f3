#include "formats/image/load_environment.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/image/exr.h"
#include "formats/image/hdr.h"
#include "formats/image/image_kind.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/file_bytes.h"

namespace opaline::formats {
namespace {

/// Negative values are not worth a word below this share of all light: lossy compression and
/// colours outside of Rec. 709 leave some.
constexpr double kSilentNegative = 1e-3;

/// Repairs impossible radiance values and counts them.
void sanitise(std::vector<Rgb>& pixel, const std::string& name, std::vector<Diagnostic>& warnings) {
    float largest = 0;
    for (const Rgb& c : pixel) {
        for (const float value : {c.r, c.g, c.b}) {
            if (std::isfinite(value)) largest = std::max(largest, value);
        }
    }
    const float cap = std::min(largest, kMaxRadiance);
    std::size_t nan = 0, negative = 0, infinite = 0, huge = 0;
    double light = 0, negative_light = 0;
    const auto repair = [&](float& value) {
        if (std::isnan(value)) {
            ++nan;
            value = 0;
        } else if (value < 0) {
            ++negative;
            negative_light -= static_cast<double>(value);
            value = 0;
        } else if (std::isinf(value)) {
            ++infinite;
            value = cap;
        } else if (value > cap) {
            ++huge;
            value = cap;
        } else {
            value += 0.0f;  // -0 becomes 0
        }
        light += static_cast<double>(value);
    };
    for (Rgb& c : pixel) {
        repair(c.r);
        repair(c.g);
        repair(c.b);
    }
    const auto report = [&](std::size_t count, const std::string& what) {
        if (count == 0) return;
        warnings.push_back(make_warning(
            name, "",
            std::to_string(count) + " of " + std::to_string(3 * pixel.size()) + " values " + what));
    };
    report(nan, "are NaN, taken as 0");
    if (negative_light > kSilentNegative * light) report(negative, "are negative, taken as 0");
    report(infinite, "are infinite, taken as the largest finite one");
    report(huge, "exceed 1e30, taken as 1e30");
}

/// OpenEXR's lat-long convention: first and last column coincide at -Z, rows include the poles.
Environment from_openexr_lat_long(const Image& image) {
    Environment environment;
    environment.width = image.width - 1;
    environment.height = image.height;
    environment.pixel.reserve(std::size_t{environment.width} * environment.height);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        const Rgb* const row = image.pixel.data() + std::size_t{y} * image.width;
        // Writers that do not repeat the column lose nothing if both count half.
        const Rgb seam = 0.5f * row[0] + 0.5f * row[image.width - 1];
        environment.pixel.push_back(seam);
        environment.pixel.insert(environment.pixel.end(), row + 1, row + image.width - 1);
    }
    // Column i lies at atan2(z, x) = 2 pi (i / width - 1/4); our u has pixel centres at i + 1/2.
    environment.u_offset = 0.25f + 0.5f / static_cast<float>(environment.width);
    environment.rows_include_poles = true;
    return environment;
}

/// Where OpenEXR's cube convention puts a direction: face 0..5 in the order +X -X +Y -Y +Z -Z, and
/// (right, down) in [-1, 1]; the faces are drawn as seen from outside (ImfEnvmap.h).
struct OpenExrCubePoint {
    std::uint32_t face = 0;
    float right = 0, down = 0;
};

OpenExrCubePoint openexr_cube_point(Vec3 p) {
    const std::uint32_t face = cube_point(p).face;
    switch (face) {
        case 0:
            return {face, p.z, -p.y};
        case 1:
            return {face, -p.z, -p.y};
        case 2:
            return {face, p.x, -p.z};
        case 3:
            return {face, p.x, p.z};
        case 4:
            return {face, -p.x, -p.y};
        default:
            return {face, p.x, -p.y};
    }
}

/// Resamples OpenEXR's cube, whose outer texel centres lie on the edges, at our texel centres.
Environment from_openexr_cube(const Image& image) {
    const std::uint32_t n = image.width;
    Environment environment;
    environment.layout = Environment::Layout::cube;
    environment.width = n;
    environment.height = 6 * n;
    environment.pixel.reserve(image.pixel.size());
    for (std::uint32_t i = 0; i < 6 * n * n; ++i) {
        const std::uint32_t row = i / n % n, column = i % n;
        const auto center = [&](std::uint32_t k) {
            return (2.0f * static_cast<float>(k) + 1.0f) / static_cast<float>(n) - 1.0f;
        };
        const OpenExrCubePoint p =
            openexr_cube_point(cube_position({i / (n * n), center(column), center(row)}));
        const float last = static_cast<float>(n - 1);
        const float x = std::clamp(0.5f * (p.right + 1.0f) * last, 0.0f, last);
        const float y = std::clamp(0.5f * (p.down + 1.0f) * last, 0.0f, last);
        const auto x0 = static_cast<std::uint32_t>(x), y0 = static_cast<std::uint32_t>(y);
        const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
        const auto at = [&](std::uint32_t c, std::uint32_t r) {
            return image
                .pixel[(std::size_t{p.face} * n + std::min(r, n - 1)) * n + std::min(c, n - 1)];
        };
        const Rgb top = (1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0);
        const Rgb bottom = (1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1);
        environment.pixel.push_back((1 - fy) * top + fy * bottom);
    }
    return environment;
}

/// Six faces side by side become six faces below each other.
Environment from_strip(Image image) {
    Environment environment;
    environment.layout = Environment::Layout::cube;
    const bool is_vertical = image.height > image.width;
    const std::uint32_t n = is_vertical ? image.width : image.height;
    environment.width = n;
    environment.height = 6 * n;
    if (is_vertical) {
        environment.pixel = std::move(image.pixel);
        return environment;
    }
    environment.pixel.reserve(image.pixel.size());
    for (std::uint32_t face = 0; face < 6; ++face) {
        for (std::uint32_t row = 0; row < n; ++row) {
            const auto first =
                image.pixel.begin() +
                static_cast<std::ptrdiff_t>(std::size_t{row} * image.width + std::size_t{face} * n);
            environment.pixel.insert(environment.pixel.end(), first,
                                     first + static_cast<std::ptrdiff_t>(n));
        }
    }
    return environment;
}

std::string size_text(const Image& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height);
}

Result<LoadedEnvironment> arrange(Image image, Envmap envmap, const std::string& name,
                                  std::vector<Diagnostic> warnings) {
    sanitise(image.pixel, name, warnings);
    const bool is_column = image.height == 6 * std::uint64_t{image.width};
    const bool is_row = image.width == 6 * std::uint64_t{image.height};
    if (envmap == Envmap::cube) {
        if (!is_column) {
            return make_error(
                ErrorKind::bad_input, name, "",
                "is marked as a cube map but has " + size_text(image) + " pixels, expected n x 6n",
                "correct its envmap attribute or its size");
        }
        return LoadedEnvironment{from_openexr_cube(image), std::move(warnings)};
    }
    if (envmap == Envmap::lat_long && (image.width < 2 || image.height < 2)) {
        return make_error(ErrorKind::bad_input, name, "",
                          "is marked as a lat-long map but has " + size_text(image) +
                              " pixels, expected at least 2 x 2",
                          "correct its envmap attribute or its size");
    }
    if (envmap == Envmap::none && (is_column || is_row)) {
        return LoadedEnvironment{from_strip(std::move(image)), std::move(warnings)};
    }
    // With the attribute the repeated column may come on top of a 2 : 1 map.
    const std::uint64_t twice = 2 * std::uint64_t{image.height};
    const bool is_two_to_one =
        image.width == twice ||
        (envmap == Envmap::lat_long && (image.width == twice + 1 || image.width + 1 == twice));
    if (!is_two_to_one) {
        warnings.push_back(make_warning(
            name, "", "is " + size_text(image) + " pixels; taken as a whole lat-long sphere",
            "expected twice as wide as high, or a cube of n x 6n or 6n x n"));
    }
    if (envmap == Envmap::lat_long) {
        return LoadedEnvironment{from_openexr_lat_long(image), std::move(warnings)};
    }
    Environment environment;
    environment.width = image.width;
    environment.height = image.height;
    environment.pixel = std::move(image.pixel);
    return LoadedEnvironment{std::move(environment), std::move(warnings)};
}

}  // namespace

Result<LoadedEnvironment> decode_environment(std::span<const std::byte> bytes,
                                             const std::string& name) {
    switch (image_kind(bytes)) {
        case ImageKind::exr: {
            Result<ExrImage> exr = decode_exr(bytes, name);
            if (!exr) return std::move(exr).error();
            return arrange(std::move(exr->image), exr->envmap, name, std::move(exr->warnings));
        }
        case ImageKind::hdr: {
            Result<HdrImage> hdr = decode_hdr(bytes, name);
            if (!hdr) return std::move(hdr).error();
            return arrange(std::move(hdr->image), Envmap::none, name, std::move(hdr->warnings));
        }
        case ImageKind::png:
            return make_error(ErrorKind::bad_input, name, "",
                              "is a PNG image, which cannot hold the radiance of a light",
                              "give an OpenEXR or Radiance HDR environment");
        case ImageKind::unknown:
            break;
    }
    return make_error(ErrorKind::bad_input, name, "",
                      bytes.empty() ? "is empty"
                                    : "is neither an OpenEXR nor a Radiance HDR image, whatever "
                                      "its name says",
                      "give a lat-long .exr or .hdr, or a cube .exr");
}

Result<LoadedEnvironment> load_environment(const std::filesystem::path& path) {
    Result<FileBytes> file = FileBytes::open(path);
    if (!file) return std::move(file).error();
    return decode_environment(file->bytes(), path.string());
}

}  // namespace opaline::formats
