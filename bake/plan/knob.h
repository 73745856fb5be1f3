#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>

namespace opaline::bake {

struct RowLayout;
struct PlanEntry;

/// How the error falls with a knob, as theory has it.
struct KnobTheory {
    std::string_view label{}, words{};  ///< of the knob on a plot; what the rate assumes
    double rate = 0;                    ///< exponent of the value; 0: no theory
    /// Not null: the exponent of e per step of the value, by the phase function's mean cosine.
    double (*rate_by_cosine)(double mean_cosine) = nullptr;
    double (*value)(double knob) = nullptr;  ///< the knob as theory counts it; null: as it is
    bool fine_is_small = false;
};

/// At most eight numbers, written in place.
class Numbers {
  public:
    constexpr Numbers() = default;
    constexpr Numbers(std::initializer_list<double> list) : size_(list.size()) {
        std::copy(list.begin(), list.end(), value_.begin());
    }

    constexpr const double* begin() const { return value_.data(); }
    constexpr const double* end() const { return begin() + size_; }
    constexpr std::size_t size() const { return size_; }
    constexpr bool empty() const { return size_ == 0; }
    constexpr double operator[](std::size_t i) const { return value_[i]; }

  private:
    std::array<double, 8> value_{};
    std::size_t size_ = 0;
};

/// A setting that trades accuracy of one effect for time or bytes. Each stands once, as a constant
/// of its effect's folder; its address identifies it.
struct KnobSpec {
    std::string_view name{};         ///< in reports, "epsilon"
    std::string_view option{};       ///< on the command line, "--epsilon"; empty: not there
    std::string_view placeholder{};  ///< of its value in --help
    std::string_view help{};
    double lowest = 0, highest = 0;  ///< that the command line accepts
    bool whole = true;               ///< an integer
    bool zero_is_auto = false;       ///< 0 stands for a choice by subject; reported as "auto"
    bool at_most_cubemap = false;    ///< a cube map size: not above Knobs::cubemap_size
    bool exact_if_given = false;     ///< otherwise an upper limit
    /// Not empty: it is a choice; its values are places in this list, and people read the words.
    std::span<const std::string_view> words{};
    Numbers allowed{};      ///< not empty: the only values, besides 0 for `auto`
    double even_media = 0;  ///< the value for which media are homogeneous; 0: there is none

    /// Values of the presets draft, preview, production, reference: each at least as accurate as
    /// the one before.
    std::array<double, 4> preset{};
    /// Of rows that are a step toward those of the file, and averaged on the way; 0: as draft.
    double coarse = 0;
    /// What a pilot for a target error starts from; null: the value of preview.
    double (*for_target)(double error) = nullptr;

    // The sweep (check/sweep).
    std::string_view label{};  ///< of a point, with %g for the value
    Numbers ladder{};          ///< values to try one by one
    /// Values where all knobs change together, -2 to 2 steps from the middle; and of the settings
    /// that serve as truth, finest first. Empty: as in the base.
    Numbers diagonal{}, truths{};

    KnobTheory theory{};

    /// Whether a subject of these rows and decisions uses it.
    bool (*matters)(const RowLayout& layout, std::span<const PlanEntry> decisions) = nullptr;
};

/// What a pilot tries for one effect: some of its knobs together, from coarse to fine.
struct PilotLadder {
    struct Setting {
        const KnobSpec* knob;
        double value;
    };
    const KnobSpec* knob;  ///< that names the ladder; given by the user, it is not tried
    std::span<const std::span<const Setting>> levels;  ///< the last one is the finest
    std::span<const Setting> finest;                   ///< what the others are measured with
    double share = 0.1;  ///< of the target's square that a coarser level may add
};

}  // namespace opaline::bake
