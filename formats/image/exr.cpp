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

/// Reads the named channels into r, g, b; a null name leaves its band at 0.
void read_pixels(const std::string& bytes, const ExrHeader& header, const char* const (&names)[3],
                 Image& image) {
    namespace imf = OPENEXR_IMF_NAMESPACE;
    MemoryInput stream(bytes);
    imf::InputFile file(stream, 0);  // no threads of its own
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    const auto first = reinterpret_cast<std::uintptr_t>(image.pixel.data());
    const std::size_t x_stride = sizeof(Rgb), y_stride = sizeof(Rgb) * header.width;
    // OpenEXR addresses pixels from the origin of its plane, not of the window.
    const std::ptrdiff_t origin = header.min_x * static_cast<std::ptrdiff_t>(x_stride) +
                                  header.min_y * static_cast<std::ptrdiff_t>(y_stride);
    imf::FrameBuffer frame;
    for (std::size_t band = 0; band < 3; ++band) {
        if (names[band] == nullptr) continue;
        const std::uintptr_t base =
            first + band * sizeof(float) - static_cast<std::uintptr_t>(origin);
        frame.insert(names[band],
                     imf::Slice(imf::FLOAT, reinterpret_cast<char*>(base), x_stride, y_stride));
    }
    file.setFrameBuffer(frame);
    const int last = header.min_y + static_cast<int>(header.height) - 1;
    file.readPixels(header.min_y, last);
}

}  // namespace

Result<ExrImage> decode_exr(std::span<const std::byte> bytes, const std::string& name) {
    if (image_kind(bytes) != ImageKind::exr) {
        return make_error(ErrorKind::bad_input, name, "",
                          "is not an OpenEXR file, whatever its name says",
                          "give an OpenEXR image");
    }
    try {
        std::string copy(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        Result<ExrHeader> header = check_exr_header(copy, name);
        if (!header) return std::move(header).error();

        const auto has = [&](std::string_view channel) {
            return contains(header->full_size, channel);
        };
        const bool has_color = has("R") || has("G") || has("B");
        if (!has_color && (!has("Y") || contains(header->subsampled, "RY"))) {
            std::string found;
            for (const auto* list : {&header->full_size, &header->subsampled}) {
                for (const std::string& channel : *list) {
                    if (found.size() < 60) found += (found.empty() ? "" : ", ") + channel;
                }
            }
            return make_error(ErrorKind::bad_input, name, "",
                              "has no channels R, G, B or Y at full resolution, but: " + found,
                              "save the colours as channels R, G and B of the first layer");
        }
        ExrImage result;
        result.envmap = header->envmap;
        result.image = {header->width, header->height, {}};
        result.image.pixel.resize(std::size_t{header->width} * header->height);
        if (has_color) {
            const char* const names[3] = {has("R") ? "R" : nullptr, has("G") ? "G" : nullptr,
                                          has("B") ? "B" : nullptr};
            read_pixels(copy, *header, names, result.image);
        } else {
            const char* const names[3] = {"Y", nullptr, nullptr};
            read_pixels(copy, *header, names, result.image);
            for (Rgb& pixel : result.image.pixel) {
                pixel = {pixel.r, pixel.r, pixel.r};
            }
        }
        if (!header->is_rec709) {
            result.warnings.push_back(make_warning(
                name, "", "its chromaticities are not those of Rec. 709; values taken as they are",
                "convert it to linear Rec. 709 (sRGB primaries)"));
        }
        const auto is_layer = [](const std::string& channel) {
            return channel.find('.') != std::string::npos;
        };
        const auto layers =
            std::count_if(header->full_size.begin(), header->full_size.end(), is_layer);
        if (layers > 0) {
            result.warnings.push_back(make_warning(
                name, "", "channels of other layers are ignored: " + std::to_string(layers)));
        }
        return result;
    } catch (const std::bad_alloc&) {
        return make_error(ErrorKind::resource, name, "", "does not fit in memory",
                          "use a smaller image");
    } catch (const std::exception& fault) {
        return make_error(ErrorKind::bad_input, name, "",
                          std::string("is damaged: OpenEXR says: ") + fault.what(),
                          "export it again");
    }
}

Result<Image> read_exr(const std::filesystem::path& path) {
    Result<FileBytes> file = FileBytes::open(path);
    if (!file) return std::move(file).error();
    Result<ExrImage> decoded = decode_exr(file->bytes(), path.string());
    if (!decoded) return std::move(decoded).error();
    return std::move(decoded->image);
}

}  // namespace opaline::formats
