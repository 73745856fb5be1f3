#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "runtime/api_support.h"
#include "runtime/parallel.h"
#include "runtime/volumes/volume_bounds.h"
#include "runtime/volumes/volume_sample.h"

namespace formats = opaline::formats;
namespace runtime = opaline::runtime;
using namespace opaline::runtime::api;

namespace {

constexpr std::uint32_t kRaysAtOnce = 64;  // for a thread: as wide as a row of a tile of pixels

formats::Vec3 point(const float p[3]) {
    return {p[0], p[1], p[2]};
}

// Of three floats that unit_vector has passed.
formats::Vec3 direction(const float d[3]) {
    return unit_vector(d).value_or(formats::Vec3{});
}

opaline_status fail_at(const char* what, std::uint32_t index, const char* fault) {
    char text[128];
    std::snprintf(text, sizeof text, "%s %lu: %s", what, static_cast<unsigned long>(index), fault);
    return invalid(text);
}

opaline_status check_pair(const opaline_asset& asset, const opaline_volume_light& volume_light) {
    return asset.id != volume_light.asset_id
               ? invalid("the volume light was made for another asset: make one for this handle")
               : OPALINE_OK;
}

formats::TermSet volume_terms_of(std::uint32_t flags) {
    using formats::TermSet;
    TermSet terms = TermSet::volume_single | TermSet::volume_multiple;
    if ((flags & OPALINE_SHADE_WITHOUT_SINGLE) != 0) terms = terms & ~TermSet::volume_single;
    if ((flags & OPALINE_SHADE_WITHOUT_MULTIPLE) != 0) terms = terms & ~TermSet::volume_multiple;
    return terms;
}

opaline_status check_options(const opaline_march_options& options) {
    if (options.struct_size != sizeof(opaline_march_options)) {
        return invalid("struct_size is not one this library knows");
    }
    if (!(options.step >= 1.0f / 64 && options.step <= 8)) {
        return invalid("the step must be 1/64 ... 8 voxels");
    }
    if (!(options.least_transmittance >= 0 && options.least_transmittance < 1)) {
        return invalid("the least transmittance must not be negative, and below 1");
    }
    if (options.threads > runtime::kMaxThreads) return invalid(kTooManyThreads);
    return OPALINE_OK;
}

// What is wrong with a ray; nullptr if nothing is.
const char* ray_fault(const opaline_march_ray& ray) {
    if (!is_finite(ray.origin, 3)) return "the origin must be finite";
    if (!unit_vector(ray.direction)) return "the direction must be finite and not zero";
    if (!(ray.begin >= 0) || !std::isfinite(ray.begin)) {
        return "the begin must be finite and not negative";
    }
    return std::isnan(ray.end) ? "the end is not a number" : nullptr;
}

const char* point_fault(const opaline_sample_point& point) {
    if (!is_finite(point.position, 3)) return "the position must be finite";
    return unit_vector(point.to_eye) ? nullptr
                                     : "the direction to the eye must be finite and not zero";
}

void store(formats::Rgb c, float out[3]) {
    out[0] = c.r;
    out[1] = c.g;
    out[2] = c.b;
}

}  // namespace

extern "C" {

uint32_t opaline_asset_volume_count(const opaline_asset* asset) {
    return asset == nullptr ? 0
                            : static_cast<std::uint32_t>(asset->loaded.view.volumes.records.size());
}

opaline_status opaline_asset_volume(const opaline_asset* asset, uint32_t index,
                                    opaline_volume_info* info) {
    if (const char* const fault = fault_of_output(asset, info)) return invalid(fault);
    if (index >= opaline_asset_volume_count(asset)) {
        return invalid("there is no volume of that index");
    }
    return guarded([&] {
        const formats::VolumesView& volumes = asset->loaded.view.volumes;
        const formats::VolumeRecord& record = volumes.records[index];
        opaline_volume_info found{};
        found.struct_size = sizeof found;
        const std::vector<formats::Vec3> corners = runtime::volume_corners(volumes, index);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const formats::Vec3 c = corners[i];
            store({c.x, c.y, c.z}, found.corner[i]);
        }
        found.bricks = record.brick_count;
        found.nodes = record.node_count;
        found.node_terms = record.single_terms + record.multiple_terms;
        found.bands = record.bands;
        *info = found;
        return OPALINE_OK;
    });
}

opaline_status opaline_volume_light_create(const opaline_asset* asset, opaline_volume_light** out) {
    if (asset == nullptr || out == nullptr) return null_argument();
    return guarded([&] {
        const formats::VolumesView& volumes = asset->loaded.view.volumes;
        auto created = std::make_unique<opaline_volume_light>();
        created->asset_id = asset->id;
        created->light = runtime::relight_volumes(
            volumes, {},
            {.terms = formats::TermSet::none, .emitters = runtime::dark_emitters(), .threads = 1});
        created->lit = runtime::light_volumes(volumes, created->light);
        *out = created.release();
        return OPALINE_OK;
    });
}

void opaline_volume_light_release(opaline_volume_light* volume_light) {
    delete volume_light;
}

opaline_status opaline_volume_light_update(opaline_volume_light* volume_light,
                                           const opaline_asset* asset, const opaline_light* light,
                                           uint32_t flags, uint32_t threads) {
    if (volume_light == nullptr || asset == nullptr || light == nullptr) return null_argument();
    const runtime::Writing writing(volume_light->users);
    const runtime::Reading reading(light->users);
    if (!writing || !reading) return busy();
    if (const auto status = check_pair(*asset, *volume_light); status != OPALINE_OK) return status;
    if (const char* const fault = fault_of_light(*light, asset->loaded.view.cubemap_size,
                                                 asset->loaded.view.emitters.size())) {
        return invalid(fault);
    }
    constexpr std::uint32_t kKnown = OPALINE_SHADE_WITHOUT_MULTIPLE | OPALINE_SHADE_WITHOUT_SINGLE |
                                     OPALINE_SHADE_WITHOUT_EMISSION;
    if ((flags & ~kKnown) != 0) return invalid("flags that volumes do not have");
    if (threads > runtime::kMaxThreads) return invalid(kTooManyThreads);
    return guarded([&] {
        // In place, so that volume_light->lit goes on referring to it.
        const bool shows_own = (flags & OPALINE_SHADE_WITHOUT_EMISSION) == 0;
        volume_light->light = runtime::relight_volumes(asset->loaded.view.volumes, light->vector(),
                                                       {.terms = volume_terms_of(flags),
                                                        .emitters = {light->emitters, shows_own},
                                                        .threads = threads});
        return OPALINE_OK;
    });
}

opaline_status opaline_volumes_march(const opaline_asset* asset,
                                     const opaline_volume_light* volume_light,
                                     const opaline_march_options* options,
                                     const opaline_march_ray* rays, uint32_t count,
                                     opaline_march_result* results) {
    if (asset == nullptr || volume_light == nullptr ||
        (count > 0 && (rays == nullptr || results == nullptr))) {
        return null_argument();
    }
    const runtime::Reading reading(volume_light->users);
    if (!reading) return busy();
    if (const auto status = check_pair(*asset, *volume_light); status != OPALINE_OK) return status;
    runtime::MarchOptions march;
    unsigned threads = 1;
    if (options != nullptr) {
        if (const auto status = check_options(*options); status != OPALINE_OK) return status;
        march.step = options->step;
        march.least_transmittance = options->least_transmittance;
        threads = options->threads;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        if (const char* const fault = ray_fault(rays[i])) return fail_at("ray", i, fault);
    }
    return guarded([&] {
        // Apart, because memory may run out half-way.
        std::vector<runtime::MarchResult> found(count);
        runtime::for_ranges(
            count, kRaysAtOnce, threads, [&](std::uint32_t begin, std::uint32_t end) {
                for (std::uint32_t i = begin; i < end; ++i) {
                    const opaline_march_ray& ray = rays[i];
                    found[i] = runtime::march_volumes(
                        volume_light->lit,
                        {point(ray.origin), direction(ray.direction),
                         static_cast<double>(ray.begin), static_cast<double>(ray.end)},
                        march);
                }
            });
        for (std::uint32_t i = 0; i < count; ++i) {
            store(found[i].radiance, results[i].radiance);
            store(found[i].transmittance, results[i].transmittance);
        }
        return OPALINE_OK;
    });
}

opaline_status opaline_volumes_sample(const opaline_asset* asset,
                                      const opaline_volume_light* volume_light,
                                      const opaline_sample_point* points, uint32_t count,
                                      opaline_sample_result* results) {
    if (asset == nullptr || volume_light == nullptr ||
        (count > 0 && (points == nullptr || results == nullptr))) {
        return null_argument();
    }
    const runtime::Reading reading(volume_light->users);
    if (!reading) return busy();
    if (const auto status = check_pair(*asset, *volume_light); status != OPALINE_OK) return status;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (const char* const fault = point_fault(points[i])) return fail_at("point", i, fault);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const runtime::VolumeSample sample = runtime::sample_volumes(
            volume_light->lit, point(points[i].position), direction(points[i].to_eye));
        store(sample.extinction, results[i].extinction);
        store(sample.scattered, results[i].scattered);
    }
    return OPALINE_OK;
}

}  // extern "C"
