#include "runtime/clouds/plane_gather.h"

#include <algorithm>

#include "runtime/parallel.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

constexpr std::int32_t kGhosts = static_cast<std::int32_t>(GatherPlan::kGhosts);

// Three floats a cell.
struct Field {
    std::uint32_t columns = 0, rows = 0;
    std::vector<float> value;

    Field(std::uint32_t c, std::uint32_t r)
        : columns(c), rows(r), value(std::size_t{3} * c * r, 0.0f) {}
    std::size_t width() const { return std::size_t{3} * columns; }
    float* row(std::uint32_t z) { return value.data() + z * width(); }
    const float* row(std::uint32_t z) const { return value.data() + z * width(); }
};

// A sum of lines to be added to another.
struct LineSum {
    std::vector<const float*> line;
    std::vector<float> weight;

    void clear() {
        line.clear();
        weight.clear();
    }
    void add(const float* values, float w) {
        line.push_back(values);
        weight.push_back(w);
    }
};

template <std::size_t kCount>
void add_block(const LineSum& sum, std::size_t at, float* out) {
    float total[kCount];
    std::copy_n(out + at, kCount, total);
    for (std::size_t k = 0; k < sum.line.size(); ++k) {
        const float* const in = sum.line[k] + at;
        const float weight = sum.weight[k];
        for (std::size_t i = 0; i < kCount; ++i) {
            total[i] += weight * in[i];
        }
    }
    std::copy_n(total, kCount, out + at);
}

// For the floats from begin to end.
void add_lines(const LineSum& sum, std::size_t begin, std::size_t end, float* out) {
    constexpr std::size_t kBlock = 32;  // 8 registers of 4 floats
    std::size_t at = begin;
    for (; at + kBlock <= end; at += kBlock) {
        add_block<kBlock>(sum, at, out);
    }
    for (; at < end; ++at) {
        add_block<1>(sum, at, out);
    }
}

// Where cell `at` lies in a line of `cells` cells with ghosts; negative where there is none.
std::int32_t place(std::int32_t at, std::uint32_t cells, bool wraps) {
    const auto count = static_cast<std::int32_t>(cells);
    if (at >= 0 && at < count) return at + kGhosts;
    if (!wraps) return at >= -kGhosts && at < count + kGhosts ? at + kGhosts : -1;
    const std::int32_t rest = at % count;
    return kGhosts + (rest < 0 ? rest + count : rest);
}

void wrap_ghosts(const GatherPlan::Level& level, Field& field) {
    const auto source = [](std::uint32_t at, std::uint32_t cells) {
        return static_cast<std::uint32_t>(
            place(static_cast<std::int32_t>(at) - kGhosts, cells, true));
    };
    for (std::uint32_t z = 0; z < field.rows; ++z) {
        for (std::uint32_t x = 0; x < field.columns; ++x) {
            const std::uint32_t from_x = source(x, level.columns), from_z = source(z, level.rows);
            if (from_x != x || from_z != z) {
                std::copy_n(field.row(from_z) + std::size_t{3} * from_x, 3,
                            field.row(z) + std::size_t{3} * x);
            }
        }
    }
}

// Cells first, first + 1, ... of a row of `level`, as many as fit in `line`.
void copy_line(const GatherPlan::Level& level, const float* row, std::int32_t first, bool wraps,
               std::span<float> line) {
    const auto cells = static_cast<std::int32_t>(level.columns);
    const auto count = static_cast<std::int32_t>(line.size() / 3);
    for (std::int32_t i = 0; i < count;) {
        const std::int32_t from = place(first + i, level.columns, wraps);
        float* const to = line.data() + 3 * i;
        // What lies before the first and behind the last cell comes one by one.
        const bool is_inside = first + i >= 0 && first + i < cells;
        const std::int32_t run = is_inside ? std::min(count - i, cells - (first + i)) : 1;
        if (from < 0) {
            std::fill_n(to, 3, 0.0f);
        } else {
            std::copy_n(row + 3 * from, 3 * run, to);
        }
        i += run;
    }
}

// out += the Gaussian of `in`, both with ghosts.
void add_gaussian(const GatherPlan::Level& level, const GatherPlan::Gaussian& gaussian, bool wraps,
                  const Field& in, unsigned threads, Field& out) {
    Field across(in.columns, in.rows);
    const std::size_t taps = gaussian.x.weight.size();
    for_ranges(in.rows, 16, threads, [&](std::uint32_t begin, std::uint32_t end) {
        std::vector<float> line(3 * (in.columns + taps - 1));
        LineSum sum;
        for (std::size_t k = 0; k < taps; ++k) {
            sum.add(line.data() + 3 * k, gaussian.x.weight[k]);
        }
        for (std::uint32_t z = begin; z < end; ++z) {
            copy_line(level, in.row(z), gaussian.x.first - kGhosts, wraps, line);
            add_lines(sum, 0, across.width(), across.row(z));
        }
    });
    // Strips so narrow that all rows of a sum stay in the nearest cache.
    const auto width = static_cast<std::uint32_t>(out.width());
    for_ranges(width, 192, threads, [&](std::uint32_t begin, std::uint32_t end) {
        LineSum sum;
        for (std::uint32_t z = 0; z < out.rows; ++z) {
            sum.clear();
            for (std::size_t k = 0; k < gaussian.z.weight.size(); ++k) {
                const std::int32_t from =
                    place(static_cast<std::int32_t>(z + k) - kGhosts + gaussian.z.first, level.rows,
                          wraps);
                if (from < 0) continue;
                sum.add(across.row(static_cast<std::uint32_t>(from)), gaussian.z.weight[k]);
            }
            add_lines(sum, begin, end, out.row(z));
        }
    });
}

// Each cell a mix of the cells of `in`, both with ghosts; what lies beyond these is 0.
Field mix_cells(const Field& in, const std::vector<GatherPlan::Mix>& x,
                const std::vector<GatherPlan::Mix>& z) {
    const auto columns = static_cast<std::uint32_t>(x.size());
    const auto rows = static_cast<std::uint32_t>(z.size());
    Field along(in.columns, rows), out(columns, rows);
    for (std::uint32_t j = 0; j < rows; ++j) {
        LineSum sum;
        for (std::uint32_t k = 0; k < z[j].count; ++k) {
            sum.add(in.row(static_cast<std::uint32_t>(z[j].first + kGhosts) + k), z[j].weight[k]);
        }
        add_lines(sum, 0, along.width(), along.row(j));
        for (std::size_t i = 0; i < columns; ++i) {
            for (std::size_t k = 0; k < x[i].count; ++k) {
                const std::size_t from = 3 * (static_cast<std::size_t>(x[i].first + kGhosts) + k);
                for (std::size_t c = 0; c < 3; ++c) {
                    out.row(j)[3 * i + c] += x[i].weight[k] * along.row(j)[from + c];
                }
            }
        }
    }
    return out;
}

Field make_field(const GatherPlan::Level& level) {
    return {level.columns + 2 * GatherPlan::kGhosts, level.rows + 2 * GatherPlan::kGhosts};
}

}  // namespace

std::vector<Rgb> gather(const GatherPlan& plan, std::span<const Rgb> radiosity, Rgb outside,
                        unsigned threads) {
    const GatherPlan::Level& finest = plan.level.front();
    if (plan.wraps) outside = {};
    // Only the differences from what is outside have an edge.
    std::vector<Field> in;
    in.push_back(make_field(finest));
    for (std::size_t i = 0; i < radiosity.size(); ++i) {
        float* const at =
            in[0].row(static_cast<std::uint32_t>(i / finest.columns) + GatherPlan::kGhosts) +
            3 * (i % finest.columns + GatherPlan::kGhosts);
        at[0] = radiosity[i].r - outside.r;
        at[1] = radiosity[i].g - outside.g;
        at[2] = radiosity[i].b - outside.b;
    }
    for (std::size_t l = 0; l < plan.level.size(); ++l) {
        const GatherPlan::Level& level = plan.level[l];
        if (l > 0) in.push_back(mix_cells(in.back(), level.reduce_x, level.reduce_z));
        if (plan.wraps) wrap_ghosts(level, in.back());
    }
    Field sum = make_field(plan.level.back());
    for (std::size_t l = plan.level.size(); l-- > 0;) {
        const GatherPlan::Level& level = plan.level[l];
        const bool is_small = std::uint64_t{level.columns} * level.rows < 4096;
        for (const GatherPlan::Gaussian& gaussian : level.gaussian) {
            add_gaussian(level, gaussian, plan.wraps, in[l], is_small ? 1 : threads, sum);
        }
        if (l > 0) sum = mix_cells(sum, level.spread_x, level.spread_z);
    }
    std::vector<Rgb> irradiance(radiosity.size());
    for (std::uint32_t z = 0; z < finest.rows; ++z) {
        for (std::uint32_t x = 0; x < finest.columns; ++x) {
            const float* const at =
                sum.row(z + GatherPlan::kGhosts) + 3 * (std::size_t{x} + GatherPlan::kGhosts);
            // Rounding may leave a little less than nothing.
            irradiance[std::size_t{z} * finest.columns + x] = {std::max(0.0f, at[0] + outside.r),
                                                               std::max(0.0f, at[1] + outside.g),
                                                               std::max(0.0f, at[2] + outside.b)};
        }
    }
    return irradiance;
}

}  // namespace opaline::runtime
