#pragma once

#include <cstdint>
#include <optional>

#include "runtime/picture/picture.h"
#include "runtime/picture/tone_map.h"

namespace opaline::cli {

/// How finished pictures come to the screen.
struct PaintLook {
    float exposure = 0;  ///< [EV]
    runtime::ToneMap tone_map = runtime::ToneMap::neutral;
    float split = 1;  ///< the second picture begins at this share of the width
    /// Instead of the second picture: how far both are apart, at each pixel the largest difference
    /// of a display colour's bands, times this gain, from black over red and yellow to white.
    float difference_gain = 0;  ///< 0: no

    bool operator==(const PaintLook&) const = default;
};

/// Tone-maps pictures into an image of the size of the window, by the window's OpenGL 3.3 context,
/// which is current in all calls and at the end of its life. Controls are drawn on the same image,
/// which then goes to the window: so what is read back does not depend on what covers the window.
class PicturePainter {
  public:
    /// Throws Refusal (messages.h): resource.
    PicturePainter();
    PicturePainter(const PicturePainter&) = delete;
    PicturePainter& operator=(const PicturePainter&) = delete;
    ~PicturePainter();

    /// Picture 0, or 1 beside it; an empty one is none.
    void upload(int which, const runtime::Picture& picture);
    /// Pictures of another size are stretched. They are tone-mapped again only where they or the
    /// look have changed. The image is bound then, to draw on.
    void paint(std::uint32_t width, std::uint32_t height, const PaintLook& look);
    /// The image so far.
    runtime::DisplayPicture read() const;
    /// To the window's framebuffer, of the same size.
    void show() const;

  private:
    void resize(std::uint32_t width, std::uint32_t height);
    void map_tones(const PaintLook& look) const;
    static constexpr int kMapped = 0, kImage = 1;  ///< pictures alone; with what is drawn on them
    std::uint32_t program_ = 0, vertex_array_ = 0;
    std::uint32_t frame_[2] = {0, 0}, image_[2] = {0, 0};
    std::uint32_t picture_[2] = {0, 0};
    bool is_there_[2] = {false, false};
    std::uint32_t picture_width_[2] = {0, 0}, picture_height_[2] = {0, 0};
    std::uint32_t width_ = 0, height_ = 0;
    std::optional<PaintLook> mapped_;  ///< the look of what was tone-mapped last
};

}  // namespace opaline::cli
