#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <numbers>

#include "formats/image/exr.h"
#include "formats/image/image_kind.h"
#include "formats/opal/atomic_file.h"

namespace opaline::formats {
namespace {

class MemoryOutput : public OPENEXR_IMF_NAMESPACE::OStream {
  public:
    MemoryOutput() : OStream("memory") {}

    void write(const char* source, int count) override {
        const auto size = static_cast<std::size_t>(std::max(count, 0));
        bytes.resize(std::max(bytes.size(), position_ + size));
        std::memcpy(bytes.data() + position_, source, size);
        position_ += size;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::string bytes;

  private:
    std::size_t position_ = 0;
};

std::string encode(const Image& image, Envmap envmap) {
    namespace imf = OPENEXR_IMF_NAMESPACE;
    imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = imf::ZIP_COMPRESSION;
    imf::addChromaticities(header, imf::Chromaticities());  // its default is Rec. 709
    if (envmap != Envmap::none) {
        imf::addEnvmap(header, envmap == Envmap::cube ? imf::ENVMAP_CUBE : imf::ENVMAP_LATLONG);
    }
    imf::FrameBuffer frame;
    // OpenEXR takes a mutable base for reading and writing alike.
    char* const first = const_cast<char*>(reinterpret_cast<const char*>(image.pixel.data()));
    const char* const names[3] = {"R", "G", "B"};
    for (std::size_t band = 0; band < 3; ++band) {
        header.channels().insert(names[band], imf::Channel(imf::FLOAT));
        frame.insert(names[band], imf::Slice(imf::FLOAT, first + band * sizeof(float), sizeof(Rgb),
                                             sizeof(Rgb) * image.width));
    }
    MemoryOutput stream;
    {
        imf::OutputFile file(stream, header, 0);  // writes its chunk table when destroyed
        file.setFrameBuffer(frame);
        file.writePixels(static_cast<int>(image.height));
    }
    return std::move(stream.bytes);
}

/// The map in a lat-long image: +X in the centre, or OpenEXR's convention, whose first and last
/// column are both -Z and whose first and last rows are the poles.
Image resample_lat_long(const Environment& environment, Envmap envmap) {
    constexpr double kPi = std::numbers::pi;
    const bool is_cube = environment.layout == Environment::Layout::cube;
    const std::uint32_t width = is_cube ? 4 * environment.width : environment.width;
    std::uint32_t height = is_cube ? 2 * environment.width : environment.height;
    const bool is_imf = envmap == Envmap::lat_long;
    height = is_imf ? std::max(height, 2u) : height;
    Image image{is_imf ? width + 1 : width, height, {}};
    image.pixel.reserve(std::size_t{image.width} * image.height);
    for (std::uint32_t y = 0; y < height; ++y) {
        const double theta = is_imf ? kPi * y / (height - 1.0) : kPi * (y + 0.5) / height;
        for (std::uint32_t x = 0; x < image.width; ++x) {
            // phi = atan2(z, x); OpenEXR's longitude atan2(x, z) = pi - 2 pi column / (W - 1).
            const double phi = is_imf ? kPi * (2.0 * (x % width) / width - 0.5)
                                      : kPi * (2.0 * (x + 0.5) / width - 1.0);
            image.pixel.push_back(
                sample_map(environment, {static_cast<float>(std::sin(theta) * std::cos(phi)),
                                         static_cast<float>(std::cos(theta)),
                                         static_cast<float>(std::sin(theta) * std::sin(phi))}));
        }
    }
    return image;
}

bool is_default_lat_long(const Environment& environment) {
    return environment.layout == Environment::Layout::lat_long && environment.u_offset == 0.5f &&
           environment.u_sign == 1.0f && !environment.rows_include_poles;
}

}  // namespace

Status write_exr(const std::filesystem::path& path, const Image& image, Envmap envmap) {
    const std::size_t pixels = std::size_t{image.width} * image.height;
    if (pixels == 0 || image.pixel.size() != pixels || pixels > kMaxImagePixels) {
        return make_error(ErrorKind::usage, path.string(), "",
                          "an image of " + std::to_string(image.width) + " x " +
                              std::to_string(image.height) + " pixels cannot be written",
                          "use a size from 1 x 1 to 16384 x 8192");
    }
    try {
        return write_file_atomically(path, encode(image, envmap));
    } catch (const std::exception& fault) {
        return make_error(ErrorKind::resource, path.string(), "",
                          std::string("cannot be encoded: OpenEXR says: ") + fault.what());
    }
}

Status write_exr(const std::filesystem::path& path, const Environment& environment, Envmap envmap) {
    if (!environment.discs.empty() || environment.pixel.empty() || envmap == Envmap::cube) {
        return make_error(ErrorKind::usage, path.string(), "",
                          envmap == Envmap::cube ? "the OpenEXR cube convention is not written"
                                                 : "an environment without a map, or with discs "
                                                   "of light, cannot be written as it is",
                          envmap == Envmap::cube ? "write it without the attribute, or lat-long"
                                                 : "rasterise it first");
    }
    const bool is_copy =
        envmap == Envmap::none &&
        (environment.layout == Environment::Layout::cube || is_default_lat_long(environment));
    if (is_copy) {
        const std::uint32_t height = environment.layout == Environment::Layout::cube
                                         ? 6 * environment.width
                                         : environment.height;
        return write_exr(path, Image{environment.width, height, environment.pixel});
    }
    return write_exr(path, resample_lat_long(environment, envmap), envmap);
}

}  // namespace opaline::formats
