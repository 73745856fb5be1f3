#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/pipeline/cost_model.h"
#include "bake/plan/stage_work.h"

namespace opaline::bake {

/// Adds stages up, and what each decision has in them: fills in a plan's predictions.
class Bill {
  public:
    /// `rates` and `plan` must outlive it; what was predicted before is forgotten. `threads` >= 1.
    Bill(const StageRates& rates, unsigned threads, std::vector<PlanEntry>& plan);

    /// `kind`: StageCost::kind; empty: the stage's name.
    void open(std::string stage, std::string kind = {});
    /// Into the stage that was opened last; `payer`: an entry of the plan that is on, or null for
    /// shared work.
    void add(const Work& work, PlanEntry* payer = nullptr);
    /// Into the file.
    void add_bytes(double bytes, PlanEntry* payer = nullptr);
    /// The decision of that name on a subject; null where it is off, or there is none.
    PlanEntry* payer(Subject::Kind kind, std::uint32_t subject, std::string_view name) const;

    CostPrediction cost;

  private:
    const StageRates& rates_;
    std::vector<PlanEntry>& plan_;
    double threads_;
    double factor_ = 1;  // of the stage that was opened last
};

/// One subject of a bake whose costs are counted.
struct CostedSubject {
    std::uint32_t material = 0;
    RowLayout layout;
    std::span<PlanEntry> decisions;
    std::vector<bool> acts;  ///< by effect, in the order of the table
    bool has_expensive_truth = false, depends_on_trials = false;
};

/// The inputs of a bake's cost.
struct CostedBake {
    const CostRequest& request;
    CostInput input;
    std::vector<CostedSubject> subjects;
    bool traces_rays = false;

    SubjectCost cost_of(const CostedSubject& subject, double receivers) const;
    /// Who pays for an effect's work on a subject: the decision that turned the effect on, or where
    /// there is none (effects/local) the first one that fills rows.
    PlanEntry* payer(const CostedSubject& subject, std::size_t effect) const;
    /// StageCost::kind of a stage in which effects of that nature do their part for these subjects:
    /// other effects take other time.
    std::string kind_of(std::string stage, std::span<const CostedSubject> some,
                        const std::function<bool(const EffectDescriptor&)>& takes_part) const;
};
CostedBake make_costed_bake(const CostRequest& request, std::vector<PlanEntry>& plan);

/// Work of rows_of_points: samples and dense rows of `points` of one subject at other knobs, of the
/// effects that act and that `counts` names.
Work work_of_points(const CostedBake& bake, const CostedSubject& subject, const Knobs& knobs,
                    double points, const std::function<bool(std::size_t effect)>& counts);

/// Work of one subject's dense rows, effect by effect, each billed to its decisions: a part that
/// adds rows pays for what they add.
void bill_rows(const CostedBake& bake, const CostedSubject& subject, double receivers, Bill& bill);
/// Of encoding them, and of their bytes in the file.
void bill_encoding(const CostedBake& bake, const CostedSubject& subject, double receivers,
                   Bill& bill);

}  // namespace opaline::bake
