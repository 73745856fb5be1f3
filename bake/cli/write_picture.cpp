#include "bake/cli/write_picture.h"

#include <cmath>
#include <utility>

#include "bake/cli/outputs.h"
#include "formats/image/exr.h"
#include "formats/image/png.h"

namespace opaline::cli {

formats::Status write_picture(const std::string& path, const runtime::Picture& picture,
                              float exposure, runtime::ToneMap map) {
    if (ending_of(path) == ".exr") {
        const float gain = std::exp2(exposure);
        formats::Image image{picture.width, picture.height, picture.pixel};
        for (formats::Rgb& pixel : image.pixel) {
            pixel = gain * pixel;
        }
        return formats::write_exr(path, image);
    }
    runtime::DisplayPicture display = runtime::tone_map(picture, exposure, map);
    return formats::write_png(path, {display.width, display.height, std::move(display.rgba)});
}

}  // namespace opaline::cli
