#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/terms.h"
#include "formats/opal/vec3.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/tone_map.h"

namespace opaline::cli {

/// Where the eye of a view stands. World space [m]; eye and target differ.
struct Viewpoint {
    formats::Vec3 eye, target, up{0, 1, 0};

    bool operator==(const Viewpoint&) const = default;
};

/// The colour of an emitter, times what it was authored as.
struct EmitterColor {
    std::string name;
    formats::Rgb color{1, 1, 1};

    bool operator==(const EmitterColor&) const = default;
};

/// What `opaline view` shows: everything that its user or a script may change, and nothing else.
/// Every state is a picture that `opaline render` can make (view_script.h), two with `other`.
struct ViewState {
    std::string file, other;  ///< `.opal` files; no `other`: one picture
    std::string light = "studio";
    std::optional<Viewpoint> viewpoint;        ///< nothing: the one that frames `file`
    std::uint32_t width = 1280, height = 800;  ///< of the picture [pixels]
    float fov = 32;                            ///< vertical angle of view [degrees], in (0, 180)
    double rotate_light = 0;                   ///< about +Y, in [0, 360) [degrees]
    double time = 0;                           ///< of cloud layers [s]
    /// [EV], in [-64, 64]; nothing: chosen from the picture (tone_map.h).
    std::optional<float> exposure;
    runtime::ToneMap tone_map = runtime::ToneMap::neutral;
    formats::TermSet terms = formats::TermSet::baked;
    std::optional<std::uint32_t> coefficients;  ///< of a row, 6 or more; nothing: all
    std::vector<EmitterColor> emitters;         ///< those that differ from what they were
    float split = 0.5f;  ///< `other` is shown right of this share of the width, in [0, 1]
    /// Right of the split: how far both pictures are apart, times this (PaintLook); 0: `other`.
    float difference_gain = 0;
    /// Instead of light: the errors by receiver that the files hold, black for 0, white from this
    /// one on (error_map.h); 0: light.
    float error_white = 0;
    bool panels = true;  ///< the window's controls are shown
};

/// The camera of a viewpoint; its near plane is left to the asset (near_plane_for).
runtime::Camera camera_of(const ViewState& state, const Viewpoint& from);

/// Whether both have the same radiance in every pixel: what is left out is done to the finished
/// picture.
bool same_radiance(const ViewState& a, const ViewState& b);

/// Turns the light to an angle [degrees], any finite one.
void rotate_light_to(ViewState& state, double degrees);

/// Multiplies the light of an emitter; a factor of 1 forgets it.
void set_emitter(ViewState& state, const std::string& name, formats::Rgb color);

/// Of an emitter; 1 where nothing was set.
formats::Rgb emitter_color(const ViewState& state, const std::string& name);

/// Shows a component or leaves it out. Precondition: one of TermSet::baked.
void toggle_term(ViewState& state, formats::TermSet term);

/// Another file in place of the first one, which is framed anew and shown as it was baked: with all
/// coefficients, terms and emitters.
void show_file(ViewState& state, const std::string& path);

/// A place on the picture: x to the right, y up, 0 in its middle; the shorter side spans [-1, 1].
struct BallPoint {
    double x = 0, y = 0;
};

/// Where a pixel lies so, from the top left corner.
BallPoint ball_point(double column, double row, double width, double height);

/// The eye around the target, with a level horizon: to the right and up, in degrees. The elevation
/// stays within 89.9 degrees of the horizon.
Viewpoint orbit_level(const Viewpoint& from, double azimuth, double elevation);

/// Arcball: the scene turns about the target so that what lies at `begin` on a ball comes to `end`.
/// Within sqrt(1/2) of the middle the ball is the unit sphere, outside a hyperbola z = 1 / (2 r),
/// which continues it smoothly (G. Bell; K. Shoemake, "ARCBALL", Graphics Interface 1992). The
/// horizon does not stay level.
Viewpoint turn_ball(const Viewpoint& from, BallPoint begin, BallPoint end);

/// Moves eye and target alike, so that what lies in the plane of the target moves by these shares
/// of the picture's height, to the right and up.
Viewpoint pan(const Viewpoint& from, float fov, double right, double up);

/// The eye's distance to the target times `factor`, which is above 0. Not below 1e-5 of the
/// target's distance from the origin.
Viewpoint zoom(const Viewpoint& from, double factor);

/// The same eye and target with +Y up.
Viewpoint level(const Viewpoint& from);

}  // namespace opaline::cli
