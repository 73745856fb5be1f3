#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/exit_cells.h"
#include "bake/effects/multiple/walks/sparse_vectors.h"
#include "bake/effects/multiple/walks/walk.h"
#include "bake/receivers/point_grid.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Surface samples and the light that enters through them, ready for exits.
class ExitLight {
  public:
    /// `light`: Haar vectors of A_j E_j; `cells`: of the same samples, or none for exits that
    /// forget their direction. `escape`: c_exit. `other`: A_j E_j of light that is diffuse
    /// (SampleTransport::other), or null. The spans must outlive this.
    ExitLight(std::span<const SurfaceSample> samples, const SparseVectors& light,
              std::optional<ExitCells> cells, double escape, const SparseVectors* other = nullptr);

    /// The same of another body that light leaves, of a boundary of its own: exits of that material
    /// look there. Its samples are numbered after the others.
    void add_body(std::uint32_t material, ExitLight light);

    /// The nearest sample that faces as the exit does; where there is none, the nearest.
    /// Precondition: there are samples.
    std::uint32_t nearest(const WalkExit& exit, std::vector<std::uint32_t>& around) const;

    /// Adds an exit at a sample to the sums of that sample, `scale` times its weight.
    void add_exit(std::uint32_t sample, const WalkExit& exit, float scale,
                  ExitCells::Sums& sums) const;

    /// Adds the light of a sample at its exits to a row. The part by cells goes to `cells`, for
    /// `add_cells`.
    void add(std::uint32_t sample, const ExitCells::Sums& sums, const TexelRow& row,
             ExitCells::Cells& cells) const;
    /// Adds the cells that `add` collected from all samples to the row.
    void add_cells(const ExitCells::Cells& cells, const TexelRow& row) const;
    /// `scale` times the weight of an exit at a sample, by band; 0 where it has no area.
    glm::vec4 weigh(std::uint32_t sample, const WalkExit& exit, float scale) const;
    /// Adds a sample's diffuse light alone, `weight`ed by band; nothing where there is none.
    void add_diffuse(std::uint32_t sample, const glm::vec4& weight, const TexelRow& row) const;
    /// The sample's light as exits see it that forget their direction, to as many rows one after
    /// the other as are asked for, with weight[row][b].
    void add_views(std::uint32_t sample, std::span<const std::array<float, 3>> weight,
                   const TexelRow& rows) const;

  private:
    // Samples of one boundary.
    struct Part {
        std::uint32_t material = formats::kNone;  // the first: of all that have no part
        std::uint32_t begin = 0;                  // number of its first sample
        std::span<const SurfaceSample> samples;
        const SparseVectors* light;
        std::optional<ExitCells> cells;
        std::vector<ExitCells::Averages> averages;  // of each sample's vector
        const SparseVectors* other;
        float scale;  // 1 / (pi c_exit)
        PointGrid grid;
        // Of each cell of the grid, the samples in it and around it: exits are many.
        std::vector<std::uint32_t> first{0};  // cells + 1, into around
        std::vector<std::uint32_t> around;

        std::uint32_t nearest(const WalkExit& exit, std::vector<std::uint32_t>& around_exit) const;
    };
    const Part& part_of(std::uint32_t& sample) const;

    std::vector<Part> parts_;
};

}  // namespace opaline::bake
