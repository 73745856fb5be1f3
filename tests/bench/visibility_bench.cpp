// The visibility stage against bare rtcOccluded16 calls on the same rays, and its scaling with
// threads. Both sides of each ratio alternate within one run: these machines are noisy.

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <chrono>
#include <limits>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/transport/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// A ball of 80 000 triangles with dents that shadow each other, on a floor.
formats::Scene dented_ball() {
    auto ball = tests::make_sphere(6, 1, {0, 1, 0});
    for (std::size_t v = 0; v < ball.position.size(); ++v) {
        const glm::vec3 n = ball.normal[v];
        ball.position[v] +=
            0.08f * std::sin(13 * n.x) * std::sin(11 * n.y) * std::sin(12 * n.z) * n;
    }
    return tests::make_scene({ball, tests::make_quad({-3, -0.1f, -3}, {0, 0, 6}, {6, 0, 0}, 60)});
}

struct Setup {
    formats::Scene scene = dented_ball();
    std::vector<Receiver> all = make_vertex_receivers(scene);
    std::vector<Receiver> receivers;
    RayScene rays = std::move(RayScene::build(scene, 0)).value();
    DirectionSet directions = make_direction_set(32);

    explicit Setup(std::size_t count) {
        // Runs of 16 neighbours, as a bake has them, spread over the whole scene.
        for (std::size_t i = 0; i < count; ++i) {
            receivers.push_back(
                all[(i / 16) * (all.size() * 16 / count) % (all.size() - 16) + i % 16]);
        }
    }

    std::uint64_t run_stage(unsigned threads) const {
        Context context;
        context.threads = threads;
        std::uint64_t traced = 0;
        for_each_block_in_order(
            receivers.size(), 8, context,
            [&](Range range) {
                std::vector<float> transport(formats::cubemap_texels(32));
                std::uint64_t count = 0;
                for (std::size_t i = range.begin; i < range.end; ++i) {
                    count += gather_irradiance(rays, directions, receivers[i], transport);
                    benchmark::DoNotOptimize(transport.data());
                }
                return count;
            },
            [&](Range, std::uint64_t count) { traced += count; });
        return traced;
    }
};

// The rays of the stage, prepared, and an Embree scene of its own to trace them with nothing else.
struct Bare {
    RTCDevice device = rtcNewDevice("isa=avx2");
    RTCScene scene = rtcNewScene(device);
    std::vector<RayPacket> packets;
    std::vector<LaneMask> masks;

    explicit Bare(const Setup& setup) {
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
        for (const formats::Primitive& p : setup.scene.primitives) {
            RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
            auto* vertex = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
                geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, p.position.size()));
            for (const glm::vec3 position : p.position) {
                *vertex++ = position;
            }
            auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
                geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, p.index.size() / 3));
            std::copy(p.index.begin(), p.index.end(), index);
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene, geometry);
            rtcReleaseGeometry(geometry);
        }
        rtcCommitScene(scene);
        for (const Receiver& r : setup.receivers) {
            const glm::vec3 origin = r.origin;
            for (const DirectionBlock& block : setup.directions.blocks) {
                RayPacket packet{};
                LaneMask mask{};
                bool any = false;
                for (std::size_t i = 0; i < RayPacket::kSize; ++i) {
                    packet.org_x[i] = origin.x, packet.org_y[i] = origin.y;
                    packet.org_z[i] = origin.z;
                    packet.mask[i] = 0xffffffffu;
                    const float cosine = r.normal.x * block.moment_x[i] +
                                         r.normal.y * block.moment_y[i] +
                                         r.normal.z * block.moment_z[i];
                    mask[i] = cosine > 0 ? -1 : 0;
                    any = any || cosine > 0;
                }
                packet.dir_x = block.dir_x, packet.dir_y = block.dir_y, packet.dir_z = block.dir_z;
                if (any) {
                    packets.push_back(packet);
                    masks.push_back(mask);
                }
            }
        }
    }
    Bare(const Bare&) = delete;
    Bare& operator=(const Bare&) = delete;
    ~Bare() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    double trace() {
        for (RayPacket& packet : packets) {
            packet.tfar.fill(std::numeric_limits<float>::infinity());
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        const auto start = Clock::now();
        for (std::size_t i = 0; i < packets.size(); ++i) {
            rtcOccluded16(masks[i].data(), scene, &context,
                          reinterpret_cast<RTCRay16*>(&packets[i]));
        }
        return seconds_since(start);
    }
};

void stage_against_bare_calls(benchmark::State& state) {
    const Setup setup(160);
    Bare bare(setup);
    double stage_seconds = 0, bare_seconds = 0;
    std::uint64_t rays = 0;
    for (auto _ : state) {
        const auto start = Clock::now();
        rays += setup.run_stage(1);
        stage_seconds += seconds_since(start);
        bare_seconds += bare.trace();
    }
    state.counters["stage_Mrays/s"] = static_cast<double>(rays) / stage_seconds * 1e-6;
    state.counters["bare_Mrays/s"] = static_cast<double>(rays) / bare_seconds * 1e-6;
    state.counters["stage/bare"] = bare_seconds / stage_seconds;
}
BENCHMARK(stage_against_bare_calls)->Unit(benchmark::kMillisecond)->MinTime(5);

void two_threads_against_one(benchmark::State& state) {
    const Setup setup(1024);
    double one = 0, two = 0;
    for (auto _ : state) {
        const auto start = Clock::now();
        setup.run_stage(1);
        one += seconds_since(start);
        const auto middle = Clock::now();
        setup.run_stage(2);
        two += seconds_since(middle);
    }
    state.counters["speedup"] = one / two;
}
BENCHMARK(two_threads_against_one)->Unit(benchmark::kMillisecond)->MinTime(5);

}  // namespace
}  // namespace opaline::bake
