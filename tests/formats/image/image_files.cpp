#include "tests/formats/image/image_files.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPreviewImage.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace opaline::formats {

std::string make_exr(const Image& image, const ExrStyle& style) {
    namespace imf = OPENEXR_IMF_NAMESPACE;
    const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
    const Imath::Box2i window({style.min_x, style.min_y},
                              {style.min_x + width - 1, style.min_y + height - 1});
    imf::Header header(window, window);
    header.compression() = static_cast<imf::Compression>(style.compression);
    if (style.envmap != Envmap::none) {
        imf::addEnvmap(header,
                       style.envmap == Envmap::cube ? imf::ENVMAP_CUBE : imf::ENVMAP_LATLONG);
    }
    if (style.is_rec2020) {
        imf::addChromaticities(header, imf::Chromaticities({0.708f, 0.292f}, {0.17f, 0.797f},
                                                           {0.131f, 0.046f}, {0.3127f, 0.329f}));
    }
    header.setPreviewImage(imf::PreviewImage(4, 4));  // an attribute that must be ignored
    imf::addOwner(header, "nobody");
    const imf::PixelType type = style.is_half ? imf::HALF : imf::FLOAT;
    std::vector<float> plane[4];
    for (const Rgb& c : image.pixel) {
        plane[0].push_back(c.r);
        plane[1].push_back(c.g);
        plane[2].push_back(c.b);
        plane[3].push_back(0.25f);
    }
    std::vector<half> halves[4];
    imf::FrameBuffer frame;
    const auto add = [&](const std::string& name, std::size_t band) {
        header.channels().insert(name, imf::Channel(type));
        std::size_t size = sizeof(float);
        char* base = reinterpret_cast<char*>(plane[band].data());
        if (style.is_half) {
            if (halves[band].empty()) {
                for (const float value : plane[band]) {
                    halves[band].push_back(half(value));
                }
            }
            size = sizeof(half);
            base = reinterpret_cast<char*>(halves[band].data());
        }
        frame.insert(name, imf::Slice::Make(type, base, window, size,
                                            size * static_cast<std::size_t>(width)));
    };
    const std::string prefix = style.prefix;
    if (style.is_grey) {
        add(prefix + "Y", 0);
    } else {
        add(prefix + "R", 0);
        add(prefix + "G", 1);
        add(prefix + "B", 2);
    }
    if (style.has_alpha) add("A", 3);
    if (style.has_layer) add("diffuse.R", 3);
    const std::filesystem::path path = temporary("made.exr");
    if (style.is_tiled) {
        header.setTileDescription(imf::TileDescription(16, 16, imf::MIPMAP_LEVELS));
        imf::TiledOutputFile file(path.c_str(), header, 0);
        // The frame serves the smaller levels too: only level 0 is looked at.
        file.setFrameBuffer(frame);
        for (int level = 0; level < file.numLevels(); ++level) {
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
    } else {
        imf::OutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(frame);
        file.writePixels(height);
    }
    std::string bytes = read_bytes(path);
    std::filesystem::remove(path);
    return bytes;
}

std::filesystem::path temporary(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) /
           ("opaline_image_" + std::to_string(::getpid()) + "_" + name);
}

std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

std::span<const std::byte> as_bytes(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string message(const Error& error) {
    const Diagnostic& first = error.diagnostics.at(0);
    return first.file + ": " + first.where + ": " + first.fault + " (" + first.remedy + ")";
}

Image ramp(std::uint32_t width, std::uint32_t height) {
    Image image{width, height, {}};
    for (std::uint32_t i = 0; i < width * height; ++i) {
        const float t = static_cast<float>(i);
        image.pixel.push_back({0.125f * t, 1000.0f + t, 1.0f / (1.0f + t)});
    }
    return image;
}

}  // namespace opaline::formats
