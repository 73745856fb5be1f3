#include "formats/image/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>

#include "formats/image/chromaticities.h"
#include "formats/image/exr_header.h"
#include "formats/image/exr_layer.h"
#include "formats/image/image_kind.h"
#include "formats/opal/file_bytes.h"

namespace opaline::formats {
namespace {

class MemoryInput : public OPENEXR_IMF_NAMESPACE::IStream {
  public:
    explicit MemoryInput(const std::string& bytes) : IStream("memory"), bytes_(bytes) {}

    bool read(char* target, int count) override {
        const auto wanted = static_cast<std::uint64_t>(std::max(count, 0));
        if (position_ > bytes_.size() || wanted > bytes_.size() - position_) {
            throw std::runtime_error("the file ends early");
        }
        std::memcpy(target, bytes_.data() + position_, wanted);
        position_ += wanted;
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

  private:
    const std::string& bytes_;
    std::uint64_t position_ = 0;
};

bool contains(const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// A channel of the file and where its first pixel goes.
struct Target {
    const char* name = nullptr;
    float* first = nullptr;
};

/// Reads channels of one part into interleaved floats, `stride` of them a pixel.
void read_pixels(const std::string& bytes, const ExrHeader& header, std::size_t part,
                 std::span<const Target> targets, std::size_t stride) {
    namespace imf = OPENEXR_IMF_NAMESPACE;
    MemoryInput stream(bytes);
    imf::MultiPartInputFile parts(stream, 0);  // no threads of its own
    imf::InputPart file(parts, static_cast<int>(part));
    const std::size_t x_stride = stride * sizeof(float), y_stride = x_stride * header.width;
    const Imath::V2i corner(header.min_x, header.min_y);
    imf::FrameBuffer frame;
    for (const Target& target : targets) {
        frame.insert(target.name, imf::Slice::Make(imf::FLOAT, target.first, corner, header.width,
                                                   header.height, x_stride, y_stride));
    }
    file.setFrameBuffer(frame);
    const int last = header.min_y + static_cast<int>(header.height) - 1;
    file.readPixels(header.min_y, last);
}

/// The channels' names, in a message.
std::string list_channels(std::span<const ExrHeader> parts) {
    std::string found;
    for (const ExrHeader& header : parts) {
        for (const auto* list : {&header.full_size, &header.subsampled}) {
            for (const std::string& channel : *list) {
                if (found.size() < 60) found += (found.empty() ? "" : ", ") + channel;
            }
        }
    }
    return found;
}

/// Vets the headers, then calls read(bytes, headers); OpenEXR's exceptions become errors.
template <class Read>
auto read_checked(std::span<const std::byte> bytes, const std::string& name, const Read& read)
    -> decltype(read(std::string(), std::vector<ExrHeader>())) {
    if (image_kind(bytes) != ImageKind::exr) {
        return make_error(ErrorKind::bad_input, name, "",
                          "is not an OpenEXR file, whatever its name says",
                          "give an OpenEXR image");
    }
    try {
        std::string copy(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        Result<std::vector<ExrHeader>> parts = check_exr_headers(copy, name);
        if (!parts) return std::move(parts).error();
        return read(copy, *parts);
    } catch (const std::bad_alloc&) {
        return make_error(ErrorKind::resource, name, "", "does not fit in memory",
                          "use a smaller image");
    } catch (const std::exception& fault) {
        return make_error(ErrorKind::bad_input, name, "",
                          std::string("is damaged: OpenEXR says: ") + fault.what(),
                          "export it again");
    }
}

Result<ExrImage> read_image(const std::string& bytes, std::span<const ExrHeader> parts,
                            const std::string& name) {
    const std::optional<ExrLayer> layer = choose_layer(parts);
    if (!layer) {
        return make_error(
            ErrorKind::bad_input, name, "",
            "has no channels R, G, B or Y at full resolution, but: " + list_channels(parts),
            "save the colours as channels R, G and B");
    }
    const ExrHeader& header = parts[layer->part];
    ExrImage result;
    result.envmap = header.envmap;
    result.image = {header.width, header.height, {}};
    std::vector<Rgb>& pixel = result.image.pixel;
    pixel.resize(std::size_t{header.width} * header.height);
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    std::vector<Target> targets;
    const auto add = [&](const std::optional<std::string>& channel, float* first) {
        if (channel) targets.push_back({channel->c_str(), first});
    };
    add(layer->red, &pixel.front().r);
    if (!layer->is_grey) {
        add(layer->green, &pixel.front().g);
        add(layer->blue, &pixel.front().b);
    }
    read_pixels(bytes, header, layer->part, targets, 3);
    if (layer->is_grey) {
        for (Rgb& grey : pixel) {
            grey = {grey.r, grey.r, grey.r};
        }
    } else if (header.chromaticities) {
        if (const auto matrix = to_rec709(*header.chromaticities)) {
            convert_colors(*matrix, pixel);
        } else {
            result.warnings.push_back(make_warning(
                name, "",
                "its chromaticities are not those of three colours and a white; values "
                "taken as linear Rec. 709",
                "correct its chromaticities attribute"));
        }
    }
    if (const std::size_t others = count_color_layers(parts); others > 1) {
        const std::string taken = layer->name.empty() ? "the channels without a layer"
                                                      : "the layer '" + layer->name + "'";
        result.warnings.push_back(make_warning(
            name, "",
            "has " + std::to_string(others) + " layers of colours; " + taken +
                (parts.size() > 1 ? " of part " + std::to_string(layer->part) : "") + " is read"));
    }
    return result;
}

}  // namespace

Result<ExrImage> decode_exr(std::span<const std::byte> bytes, const std::string& name) {
    const auto read = [&](const std::string& copy, const std::vector<ExrHeader>& parts) {
        return read_image(copy, parts, name);
    };
    return read_checked(bytes, name, read);
}

Result<ScalarImage> decode_exr_channel(std::span<const std::byte> bytes, const std::string& name,
                                       std::initializer_list<const char*> names,
                                       std::uint32_t most_side) {
    const auto read_part = [&](const std::string& copy, const ExrHeader& header, std::size_t part,
                               const char* channel) -> Result<ScalarImage> {
        if (std::max(header.width, header.height) > most_side) {
            return make_error(ErrorKind::bad_input, name, "",
                              "has " + std::to_string(header.width) + " x " +
                                  std::to_string(header.height) + " pixels, the limit is " +
                                  std::to_string(most_side) + " on a side",
                              "use a smaller image");
        }
        ScalarImage image{header.width, header.height, {}};
        image.value.resize(std::size_t{header.width} * header.height);
        const Target target{channel, image.value.data()};
        read_pixels(copy, header, part, {&target, 1}, 1);
        return image;
    };
    const auto read = [&](const std::string& copy,
                          const std::vector<ExrHeader>& parts) -> Result<ScalarImage> {
        std::string wanted;
        for (const char* channel : names) {
            for (std::size_t part = 0; part < parts.size(); ++part) {
                if (!parts[part].is_deep && contains(parts[part].full_size, channel)) {
                    return read_part(copy, parts[part], part, channel);
                }
            }
            wanted += (wanted.empty() ? "" : " or ") + std::string(channel);
        }
        return make_error(
            ErrorKind::bad_input, name, "",
            "has no channel " + wanted + " at full resolution, but: " + list_channels(parts),
            "save the values as one of them");
    };
    return read_checked(bytes, name, read);
}

Result<Image> read_exr(const std::filesystem::path& path) {
    Result<FileBytes> file = FileBytes::open(path);
    if (!file) return std::move(file).error();
    Result<ExrImage> decoded = decode_exr(file->bytes(), path.string());
    if (!decoded) return std::move(decoded).error();
    return std::move(decoded->image);
}

}  // namespace opaline::formats
