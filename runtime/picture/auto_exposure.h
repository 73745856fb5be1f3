#pragma once

#include "runtime/picture/camera.h"
#include "runtime/picture/picture.h"

namespace opaline::runtime {

/// The camera of the small picture that an exposure is chosen from: the same view, at most 96
/// pixels along a side. The picture is drawn with one sample a pixel, and without the background
/// unless there is a cloud layer, so that objects are exposed whatever stands behind them.
Camera meter_camera(const Camera& camera);

/// Exposure of a picture [EV], from a metered one. With L the geometric mean of the luminance of
/// the brighter half of its pixels that are not black (robust against shadows and highlights): 0
/// for L from 1/64 to 1.5, so that what is lit by some radiance of 1 looks as it is. Brighter ones
/// are shown darker, from 12 up at 0.35; dimmer ones stay dim: they are raised to 1/64, by 10 EV at
/// most. Continuous in L, in steps of 0.01 EV. 0 for a black picture.
float choose_exposure(const Picture& metered);

}  // namespace opaline::runtime
