#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "bake/lab/sweep/reference_ladder.h"
#include "bake/lab/sweep/run_point.h"
#include "bake/plan/stage_work.h"

namespace opaline::bake {

/// A flag for Context::cancel that is set once so many seconds are over, or once `outer`, which may
/// be null, is set.
class TimeLimit {
  public:
    TimeLimit(double seconds, const std::atomic<bool>* outer);

    const std::atomic<bool>* flag() const { return &over_; }

  private:
    std::atomic<bool> over_ = false;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread watch_;  // last: it reads the others
};

struct SweepOptions {
    BakeOptions bake;           ///< effects, seed and threads; each point sets the knobs itself
    double seconds = 300;       ///< of bakes and truths together: what is not done is left out
    double most_bytes = 4e9;    ///< nor one whose file is predicted to be larger
    std::size_t probes = 2000;  ///< receivers to compare at, at most
    StageRates rates;           ///< of this machine
    std::string light = "sky:3,35";  ///< of the pictures
};

/// A point that was not baked.
struct SkippedPoint {
    SweepPoint point;
    double predicted_seconds = 0, predicted_bytes = 0;
    std::string reason;
};

struct SweepResult {
    std::string source, sha256;  ///< of the scene; source without its folder
    std::uint64_t receivers = 0, triangles = 0;
    unsigned threads = 1;  ///< as used
    std::uint64_t seed = 0;
    double mean_cosine = 0;  ///< of the first medium's phase function
    SweepSubject subject;
    Quality base = Quality::preview;  ///< preset of which the ladders change one knob
    std::vector<PlanEntry> plan;      ///< of the base
    std::vector<PointRecord> points;  ///< in the order in which they were baked
    /// index of the finest point of the choices that most points made (find_finest)
    std::size_t truth = 0;
    std::optional<ReferenceLadder> reference;  ///< nothing: no light, or no time
    std::vector<SkippedPoint> skipped;
    std::vector<std::string> lights;
    std::string picture_light;
    double seconds = 0;  ///< of the whole sweep
};

/// The point about to be baked, and the largest number of points.
struct SweepStep {
    std::size_t done = 0, total = 0;
    const std::string& label;
};

/// Bakes the ladders of a scene. Order: `draft`; the ladder of the Monte Carlo reference, and the
/// path tracing that total errors are against, for a twentieth of the time each; the most accurate
/// setting that half of the time allows; the other presets; choices; one-at-a-time and diagonal
/// ladders and grids, cheap points first. The ladders stand
/// around `preview`, or `draft` where a twentieth of the time is less than `preview` takes.
/// No point is begun that is predicted to end too late: predictions are predict_costs', scaled by
/// how long the points so far took. A point or truth that is not done in time is stopped and
/// skipped, as is a point that runs out of memory. Errors: as run_bake; usage, for a light that is
/// none or too little time.
formats::Result<SweepResult> run_sweep(const EffectTable& effects, const formats::Scene& scene,
                                       const SweepOptions& options, const Context& context,
                                       const std::function<void(const SweepStep&)>& on_step);

}  // namespace opaline::bake
