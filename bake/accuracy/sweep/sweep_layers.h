#pragma once

#include <span>
#include <vector>

#include "bake/accuracy/measure_error.h"
#include "bake/accuracy/sweep/run_point.h"
#include "bake/layers/layer_error.h"
#include "formats/opal/clouds.h"

namespace opaline::bake {

/// Radiance of the light that a layer's droplets scatter [1/sr], per irradiance facing the light,
/// as its tables give it: at optical depths, lights, views, azimuths, sides and bands that are the
/// same for all bakes. Of all layers; places of one group (depth, light, side, band) follow each
/// other.
std::vector<double> read_layer_radiance(const formats::CloudsView& clouds);

/// Divides the layers' radiances of all points by the RMS of their group in the first one: groups
/// then count alike, as they do in LayerErrorReport. Precondition: of the same scene.
void scale_layer_radiance(std::span<PointRecord> points);

/// A bake's error is the larger one, of surfaces and volumes or of its layer.
void take_larger(ErrorReport& error, const LayerErrorReport& layer);

}  // namespace opaline::bake
