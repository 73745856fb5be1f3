#include "runtime/picture/picture.h"

#include <new>
#include <string>

namespace opaline::runtime {

formats::Result<Picture> make_picture(std::uint32_t width, std::uint32_t height) {
    Picture picture{width, height, {}};
    try {
        picture.pixel.resize(std::size_t{width} * height);
    } catch (const std::bad_alloc&) {
        return formats::make_error(
            formats::ErrorKind::resource, {}, "picture",
            "no memory for " + std::to_string(width) + "x" + std::to_string(height) + " pixels",
            "choose a smaller size");
    }
    return picture;
}

}  // namespace opaline::runtime
