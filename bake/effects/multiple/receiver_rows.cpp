#include "bake/effects/multiple/receiver_rows.h"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/limit_views.h"
#include "bake/effects/multiple/walks/view_fit.h"

namespace opaline::bake {
namespace {

// The constant stands in the first row even where more harmonics follow it.
std::uint32_t term_of(std::uint32_t harmonic, const RowLayout& layout) {
    return harmonic == 0 ? 0 : layout.first_harmonic() + harmonic;
}

// By how much a row by view counts in a harmonic.
class ViewFactors {
  public:
    ViewFactors(const ViewFit& fit, const ViewLimit& limit, glm::vec3 normal)
        : matrix_(to_harmonics(fit, normal)), limit_(limit) {}
    float operator()(std::uint32_t harmonic, std::uint32_t row) const {
        return (row < kFirstDegree ? limit_.first : limit_.second) * matrix_[harmonic][row];
    }

  private:
    ViewMatrix matrix_;
    ViewLimit limit_;
};

// Adds factor * sums, four floats per texel (one with one band), to a row of `to`.
void add_sums(std::span<const float> sums, float factor, std::uint32_t row, const DenseRow& to) {
    const std::size_t step = to.bands == 1 ? 1 : 4;
    for (std::uint32_t band = 0; band < to.bands; ++band) {
        const std::span<float> plane = to.plane(row, band);
        for (std::size_t k = 0; k < plane.size(); ++k) {
            plane[k] += factor * sums[step * k + band];
        }
    }
}

// `rows` by view as harmonics of the view w'. `sums`: T_d / scale.
void add_views(const ViewFit& fit, glm::vec3 normal, std::span<const float> sums,
               std::span<const float> rows, float scale, const RowLayout& layout,
               const DenseRow& row) {
    const ViewFactors factors(fit, limit_views(sums, rows, row.bands == 1 ? 1 : 4, normal, fit),
                              normal);
    for (std::uint32_t k = 0; k < layout.view_harmonics; ++k) {
        for (std::uint32_t r = 0; r + 1 < layout.view_harmonics; ++r) {
            const float factor = scale * factors(k, r);
            if (factor != 0) {
                add_sums(rows.subspan(r * sums.size(), sums.size()), factor, term_of(k, layout),
                         row);
            }
        }
    }
}

// What limit_views asks of rows: the average of each face.
std::vector<float> face_averages(const SiteRowSum& sum, std::uint32_t rows, const DenseRow& row) {
    constexpr std::size_t kFaces = 6;
    const std::size_t face = row.size() / kFaces, step = row.bands == 1 ? 1 : 4;
    std::vector<float> averages(rows * kFaces * step);
    for (std::uint32_t r = 0; r < rows; ++r) {
        for (std::size_t f = 0; f < kFaces; ++f) {
            for (std::uint32_t band = 0; band < row.bands; ++band) {
                averages[(r * kFaces + f) * step + band] = sum.at(r, f * face, band);
            }
        }
    }
    return averages;
}

// From sites inside; a walked row is T_d / (pi c_exit).
void add_inner_rows(const WalkStage& walks, const BodyPoint& point, const RowLayout& layout,
                    const DenseRow& row) {
    const std::uint32_t rows = std::max(1u, layout.view_harmonics);
    const SiteRowSum sum = sum_inner_rows(walks, point, row.size(), rows);
    std::vector<SiteRowSum::Share> shares(rows);
    shares[0].of_row[0] = static_cast<float>(1 / layout.view_of_constant());
    if (rows > 1) {
        const std::vector<float> averages = face_averages(sum, rows, row);
        const std::span<const float> all(averages);
        const std::size_t one = averages.size() / rows;
        const ViewLimit limit = limit_views(all.first(one), all.subspan(one),
                                            row.bands == 1 ? 1 : 4, point.normal, walks.view_fit);
        const ViewFactors factors(walks.view_fit, limit, point.normal);
        for (std::uint32_t k = 0; k < rows; ++k) {
            shares[k].term = term_of(k, layout);
            for (std::uint32_t r = 0; r + 1 < rows; ++r) {
                shares[k].of_row[r + 1] = factors(k, r);
            }
        }
    }
    sum.add_to(shares, row);
}

}  // namespace

void add_multiple_rows(const MultipleStage& stage, const BodyPoint& point, double tolerance,
                       const RowLayout& layout, const DenseRow& row) {
    if (!stage.walks.inner.empty() && !stage.walks.rows.blocks.empty()) {
        add_inner_rows(stage.walks, point, layout, row);
        return;
    }
    const double scale = 1 / (std::numbers::pi * stage.medium.exit);
    std::vector<float> sums((row.bands == 1 ? 1 : 4) * row.size());
    const std::uint32_t by_view = std::max(1u, layout.view_harmonics) - 1;
    std::vector<float> views(by_view * sums.size());
    gather_multiple_rows(stage, point, tolerance, row.bands, sums, views);
    add_sums(sums, static_cast<float>(scale / layout.view_of_constant()), 0, row);
    if (by_view > 0) {
        add_views(stage.walks.view_fit, point.normal, sums, views, static_cast<float>(scale),
                  layout, row);
    }
}

}  // namespace opaline::bake
