#include "tests/formats/image/image_files.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
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
    if (style.chromaticities) {
        const Chromaticities& c = *style.chromaticities;
        imf::addChromaticities(
            header, imf::Chromaticities({c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}));
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
    if (style.has_layer) {
        for (const char* channel : {"diffuse.R", "diffuse.G", "diffuse.B"}) {
            add(channel, 3);
        }
    }
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

std::string make_exr_of_parts(const Image& image) {
    namespace imf = OPENEXR_IMF_NAMESPACE;
    const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
    const Imath::Box2i window({0, 0}, {width - 1, height - 1});
    std::vector<imf::Header> headers(2, imf::Header(window, window));
    headers[0].setName("depth");
    headers[1].setName("light");
    for (imf::Header& header : headers) {
        header.setType(imf::SCANLINEIMAGE);
    }
    headers[0].channels().insert("Z", imf::Channel(imf::FLOAT));
    for (const char* band : {"R", "G", "B"}) {
        headers[1].channels().insert(band, imf::Channel(imf::FLOAT));
    }
    const std::filesystem::path path = temporary("parts.exr");
    {
        imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
        const auto* first = reinterpret_cast<const char*>(image.pixel.data());
        const std::size_t across = sizeof(Rgb), down = across * image.width;
        imf::FrameBuffer depth, light;
        const auto add = [&](imf::FrameBuffer& frame, const char* name, std::size_t band) {
            frame.insert(name, imf::Slice::Make(imf::FLOAT, first + band * sizeof(float), window,
                                                across, down));
        };
        add(depth, "Z", 0);
        add(light, "R", 0);
        add(light, "G", 1);
        add(light, "B", 2);
        imf::OutputPart depth_part(file, 0), light_part(file, 1);
        depth_part.setFrameBuffer(depth);
        depth_part.writePixels(height);
        light_part.setFrameBuffer(light);
        light_part.writePixels(height);
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
