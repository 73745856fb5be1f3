#include "bake/effects/volumes/add_scattered.h"

#include "bake/base/vector8.h"
#include "bake/trace/density/attenuation.h"

namespace opaline::bake {
namespace {

struct CellJob {
    const float *x, *y, *z;
    const std::uint16_t* depth[8];
    float node_weight[8];  // times the step of the codes
    float direction_x, direction_y, direction_z;
    float phase[5];
    float weight[3];
    std::size_t cells, bands;
    float* sum;
};

OPALINE_VECTOR_CLONES
void add_cells(const CellJob& job);

void add_cells(const CellJob& given) {
    const CellJob job = given;  // a copy that stores through other pointers cannot change
    using Codes = std::uint16_t __attribute__((vector_size(16)));
    for (std::size_t i = 0; i < job.cells; i += kVector) {
        const Float8 x = load8(job.x + i), y = load8(job.y + i), z = load8(job.z + i);
        const Float8 cosine = job.direction_x * x + job.direction_y * y + job.direction_z * z;
        Float8 p = all8(job.phase[4]);
        p = p * cosine + job.phase[3];
        p = p * cosine + job.phase[2];
        p = p * cosine + job.phase[1];
        p = p * cosine + job.phase[0];
        Float8 depth = all8(0.0f);
        for (std::size_t node = 0; node < 8; ++node) {
            Codes codes;
            __builtin_memcpy(&codes, job.depth[node] + i, sizeof codes);
            depth += job.node_weight[node] *
                     __builtin_convertvector(__builtin_convertvector(codes, Int8), Float8);
        }
        const Float8 light = p * exp_of_negative8(-depth);
        for (std::size_t band = 0; band < job.bands; ++band) {
            float* const to = job.sum + band * job.cells + i;
            store8(load8(to) + job.weight[band] * light, to);
        }
    }
}

}  // namespace

void add_scattered(const ScatteredLight& light, const LightCells& cells, std::size_t bands,
                   float* sum) {
    CellJob job{};
    job.x = cells.x.data();
    job.y = cells.y.data();
    job.z = cells.z.data();
    for (std::size_t node = 0; node < 8; ++node) {
        job.depth[node] = light.depth[node];
        job.node_weight[node] = light.node_weight[node] * DepthTable::kStep;
    }
    job.direction_x = light.direction.x;
    job.direction_y = light.direction.y;
    job.direction_z = light.direction.z;
    for (std::size_t i = 0; i < light.phase->size(); ++i) {
        job.phase[i] = (*light.phase)[i];
    }
    for (std::size_t band = 0; band < 3; ++band) {
        job.weight[band] = light.weight[band];
    }
    job.cells = cells.size();
    job.bands = bands;
    job.sum = sum;
    add_cells(job);
}

}  // namespace opaline::bake
