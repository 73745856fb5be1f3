#pragma once

#include <cstdint>

#include "formats/opal/asset.h"
#include "formats/opal/vec3.h"

namespace opaline::runtime {

/// A pinhole camera. World space, right-handed, +Y up, lengths in metres.
/// Both backends keep 1/distance as depth, so there is no far plane.
struct Camera {
    formats::Vec3 eye{0, 0, 1};
    formats::Vec3 target{0, 0, 0};
    formats::Vec3 up{0, 1, 0};                ///< need not be perpendicular to the view
    float fov_y = 40;                         ///< full vertical angle of view [deg], in (0, 180)
    std::uint32_t width = 960, height = 720;  ///< of the picture, in pixels
    float near_plane = 1e-3f;                 ///< nothing nearer along the view axis is drawn, > 0
};

/// Orthonormal frame of a camera: x to the right, y up, z toward the viewer. Defined for every
/// camera, also with eye = target (then looking along -Z) or `up` along the view.
struct CameraFrame {
    formats::Vec3 right, up, backward;
    double tan_half_x = 1, tan_half_y = 1;  ///< half extents of the image plane at distance 1
};
CameraFrame camera_frame(const Camera& camera);

/// Unit direction, in world space, of the view ray through image point (x, y) in pixels, from the
/// top left corner; pixel centres lie at half-integers.
formats::Vec3 view_ray(const Camera& camera, const CameraFrame& frame, double x, double y);

/// A sphere that holds a set of points; radius 0 and centre 0 for none.
struct BoundingSphere {
    double x = 0, y = 0, z = 0, radius = 0;
};

/// Around all vertices of the asset and all bricks of its volumes.
BoundingSphere bound_asset(const formats::AssetView& asset);

/// Around what a picture is about: everything but a ground. A ground is the widest level part that
/// lies below the rest, with what is level with it (tiles), where the picture would hold the rest
/// at less than 1/1.3 of its size with it. Any other flat primitive is left out only where it is at
/// least three times as large as all the rest: a thin box, or a sheet whose triangles all face
/// nearly the same way.
BoundingSphere bound_object(const formats::AssetView& asset);

/// The same as a cylinder around the vertical axis through the middle of its box, which an orbit
/// keeps in frame; 0 for nothing. [m]
struct UprightBounds {
    double radius = 0, half_height = 0;
};
UprightBounds bound_upright(const formats::AssetView& asset);

/// From a target to the eye, by angles [degrees]: azimuth from +Z toward +X, elevation above the
/// horizon. Unit.
formats::Vec3 view_direction(double azimuth, double elevation);

/// Of the triangle area that faces `direction` or faces away from it, projected, the share that
/// faces it; double-sided primitives always do. 1 for an asset without triangles.
double front_share(const formats::AssetView& asset, formats::Vec3 direction);

/// A view from a unit direction in which what bound_object holds fills the frame, with a margin of
/// 4 %, and stays in it while the camera orbits. Defined for every asset: empty, a point, any size.
Camera frame_from(const formats::AssetView& asset, formats::Vec3 direction, float fov_y,
                  std::uint32_t width, std::uint32_t height);

/// The default view: frame_from 30 degrees from +Z toward +X, 10 degrees above the horizon, so that
/// the horizon is in the picture; up to 22 degrees for what is lower than half its radius. Where
/// more than three quarters of the area face away from there, the azimuth is that of the quarter
/// turns that shows the largest share of front faces. Of a cloud layer alone: frame_layer.h.
Camera frame_asset(const formats::AssetView& asset, float fov_y, std::uint32_t width,
                   std::uint32_t height);

/// The near plane for a camera placed by the user: half way to the asset, or a thousandth of its
/// radius where the eye is near or inside. kLayerNearPlane where there is a cloud layer, which may
/// begin at the eye, and less for an asset whose radius is below 100 m.
inline constexpr float kLayerNearPlane = 0.1f;  ///< [m]
float near_plane_for(const formats::AssetView& asset, formats::Vec3 eye);

/// The camera moved around the vertical axis through its target by `degrees`, from +Z toward +X:
/// one frame of a turntable.
Camera orbit(const Camera& camera, float degrees);

}  // namespace opaline::runtime
