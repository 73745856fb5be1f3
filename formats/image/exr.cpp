#include "formats/image/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "formats/image/exr_header.h"
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

/// Reads channels into interleaved floats, `stride` of them a pixel.
void read_pixels(const std::string& bytes, const ExrHeader& header, std::span<const Target> targets,
                 std::size_t stride) {
    namespace imf = OPENEXR_IMF_NAMESPACE;
    MemoryInput stream(bytes);
    imf::InputFile file(stream, 0);  // no threads of its own
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
std::string list_channels(const ExrHeader& header) {
    std::string found;
    for (const auto* list : {&header.full_size, &header.subsampled}) {
        for (const std::string& channel : *list) {
            if (found.size() < 60) found += (found.empty() ? "" : ", ") + channel;
        }
    }
    return found;
}

/// Vets the header, then calls read(bytes, header); OpenEXR's exceptions become errors.
template <class Read>
auto read_checked(std::span<const std::byte> bytes, const std::string& name, const Read& read)
    -> decltype(read(std::string(), ExrHeader())) {
    if (image_kind(bytes) != ImageKind::exr) {
        return make_error(ErrorKind::bad_input, name, "",
                          "is not an OpenEXR file, whatever its name says",
                          "give an OpenEXR image");
    }
    try {
        std::string copy(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        Result<ExrHeader> header = check_exr_header(copy, name);
        if (!header) return std::move(header).error();
        return read(copy, *header);
    } catch (const std::bad_alloc&) {
        return make_error(ErrorKind::resource, name, "", "does not fit in memory",
                          "use a smaller image");
    } catch (const std::exception& fault) {
        return make_error(ErrorKind::bad_input, name, "",
                          std::string("is damaged: OpenEXR says: ") + fault.what(),
                          "export it again");
    }
}

Result<ExrImage> read_image(const std::string& bytes, const ExrHeader& header,
                            const std::string& name) {
    const auto has = [&](std::string_view channel) { return contains(header.full_size, channel); };
    const bool has_color = has("R") || has("G") || has("B");
    if (!has_color && (!has("Y") || contains(header.subsampled, "RY"))) {
        return make_error(
            ErrorKind::bad_input, name, "",
            "has no channels R, G, B or Y at full resolution, but: " + list_channels(header),
            "save the colours as channels R, G and B of the first layer");
    }
    ExrImage result;
    result.envmap = header.envmap;
    result.image = {header.width, header.height, {}};
    std::vector<Rgb>& pixel = result.image.pixel;
    pixel.resize(std::size_t{header.width} * header.height);
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    std::vector<Target> targets;
    for (const Target& band : {Target{"R", &pixel.front().r}, Target{"G", &pixel.front().g},
                               Target{"B", &pixel.front().b}}) {
        if (has(band.name)) targets.push_back(band);
    }
    if (!has_color) {
        targets = {{"Y", &pixel.front().r}};
    }
    read_pixels(bytes, header, targets, 3);
    if (!has_color) {
        for (Rgb& grey : pixel) {
            grey = {grey.r, grey.r, grey.r};
        }
    }
    if (!header.is_rec709) {
        result.warnings.push_back(make_warning(
            name, "", "its chromaticities are not those of Rec. 709; values taken as they are",
            "convert it to linear Rec. 709 (sRGB primaries)"));
    }
    const auto is_layer = [](const std::string& channel) {
        return channel.find('.') != std::string::npos;
    };
    const auto layers = std::count_if(header.full_size.begin(), header.full_size.end(), is_layer);
    if (layers > 0) {
        result.warnings.push_back(make_warning(
            name, "", "channels of other layers are ignored: " + std::to_string(layers)));
    }
    return result;
}

}  // namespace

Result<ExrImage> decode_exr(std::span<const std::byte> bytes, const std::string& name) {
    return read_checked(bytes, name, [&](const std::string& copy, const ExrHeader& header) {
        return read_image(copy, header, name);
    });
}

Result<ScalarImage> decode_exr_channel(std::span<const std::byte> bytes, const std::string& name,
                                       std::initializer_list<const char*> names,
                                       std::uint32_t most_side) {
    const auto read = [&](const std::string& copy, const ExrHeader& header) -> Result<ScalarImage> {
        if (std::max(header.width, header.height) > most_side) {
            return make_error(ErrorKind::bad_input, name, "",
                              "has " + std::to_string(header.width) + " x " +
                                  std::to_string(header.height) + " pixels, the limit is " +
                                  std::to_string(most_side) + " on a side",
                              "use a smaller image");
        }
        std::string wanted;
        for (const char* channel : names) {
            if (contains(header.full_size, channel)) {
                ScalarImage image{header.width, header.height, {}};
                image.value.resize(std::size_t{header.width} * header.height);
                const Target target{channel, image.value.data()};
                read_pixels(copy, header, {&target, 1}, 1);
                return image;
            }
            wanted += (wanted.empty() ? "" : " or ") + std::string(channel);
        }
        return make_error(
            ErrorKind::bad_input, name, "",
            "has no channel " + wanted + " at full resolution, but: " + list_channels(header),
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
