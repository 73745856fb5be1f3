#include "bake/pipeline/row_stages.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/rows/shared_batches.h"
#include "bake/encode/row_sink.h"
#include "bake/trace/bake_openness.h"
#include "bake/trace/direction_set.h"

namespace opaline::bake {
namespace {

// What the rows of a set are for, in the words of comparisons: "multiple+single: rows".
std::string group_of(std::span<const Gatherer> gatherers) {
    std::string names;
    for (const Gatherer& g : gatherers) {
        names += (names.empty() ? "" : "+") + std::string(g.effect->name);
    }
    return names.empty() ? kPreparationGroup : names + ": rows";
}

}  // namespace

formats::Result<GatheredRows> bake_rows(const BakeInputs& bake, const VolumesBefore* volumes,
                                        std::span<const SubjectState> subjects, const Knobs& knobs,
                                        bool measures_errors, const Context& context,
                                        StageLog& log) {
    std::vector<float> errors;
    RowSink sink =
        make_row_sink(make_row_encoder(knobs.cubemap_size, knobs.coefficients, knobs.code_bits));
    const std::uint32_t total = count_receivers(bake.receivers);
    SharedBatches batches(bake, subjects, knobs, context);
    for (std::size_t s = 0; s < bake.receivers.size(); ++s) {
        const ReceiverSet& set = bake.receivers[s];
        const SubjectState* const subject =
            set.size() == 0 ? nullptr : &state_of(subjects, set.material);
        if (subject == nullptr) continue;
        std::vector<Gatherer> gatherers = make_gatherers(bake, *subject, knobs, context);
        std::string group = group_of(gatherers);
        RowJob job{set, subject->layout, sink.encoder, total};
        job.measures_errors = measures_errors;
        job.volumes = volumes;
        job.material = &bake.scene.materials[set.material];
        GatheredRows gathered =
            run_stage(log, "rows of '" + bake.scene.primitives[set.primitive].name + "'",
                      std::move(group), [&](std::uint64_t& rays) {
                          const SharedBatches::Found shared = batches.find(s, rays);
                          job.shared = shared.gatherers;
                          job.place = shared.place;
                          return gather_rows(job, std::move(gatherers), context, rays);
                      });
        formats::SparseRows& part = gathered.rows;
        if (context.cancelled()) break;
        const RowLayout& layout = subject->layout;
        if (auto status = require_finite(part, layout.terms(), layout.bands(), log.back().name);
            !status) {
            return std::move(status).error();
        }
        if (part.row_offset.size() != layout.terms() * set.size() + 1 ||
            !take_rows(sink, std::move(part))) {
            return formats::make_error(formats::ErrorKind::resource, "", "transport",
                                       "more than 2^32 coefficients do not fit into one file",
                                       "lower --coefficients, or split the scene");
        }
        errors.insert(errors.end(), gathered.receiver_error.begin(), gathered.receiver_error.end());
    }
    return GatheredRows{std::move(sink.rows), std::move(errors)};
}

std::vector<formats::Openness> bake_all_openness(const BakeInputs& bake,
                                                 std::span<const SubjectState> subjects,
                                                 const Context& context, StageLog& log) {
    std::vector<formats::Openness> openness;
    if (std::none_of(subjects.begin(), subjects.end(),
                     [](const SubjectState& s) { return s.layout.mirrors; })) {
        return openness;
    }
    return run_stage(log, "openness", "openness", [&](std::uint64_t& traced) {
        const DirectionSet directions = make_sparse_direction_set(kOpennessCubemap, 0);
        for (const ReceiverSet& set : bake.receivers) {
            if (set.size() > 0 && state_of(subjects, set.material).layout.mirrors) {
                const bool occluded = state_of(subjects, set.material).layout.occluded;
                const auto part = bake_openness(occluded ? bake.rays : bake.sky, directions,
                                                set.outside, context, traced);
                openness.insert(openness.end(), part.begin(), part.end());
            }
            openness.resize(set.first + set.size());
        }
        return std::move(openness);
    });
}

}  // namespace opaline::bake
