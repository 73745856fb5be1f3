// Writes the cumulus of `opaline example cumulus` with other voxels, to measure bakes of larger
// grids:
//
//   opaline_bench write-cloud OUT.vdb [VOXEL]     edges in metres, default 3.5: about a million
//   active voxels
#include <cstdio>
#include <cstdlib>

#include "bake/lab/example/density_fields.h"
#include "formats/vdb/write_vdb.h"
#include "tests/bench/bench.h"

int opaline::tests::write_cloud(int argc, char** argv) {
    const double voxel = argc > 2 ? std::atof(argv[2]) : 3.5;
    if (argc < 2 || argv[1][0] == '-' || !(voxel >= 1 && voxel <= 100)) {
        std::fputs("usage: opaline_bench write-cloud OUT.vdb [VOXEL], VOXEL from 1 to 100 m\n",
                   stderr);
        return 2;
    }
    const auto grid = opaline::bake::make_cumulus_density(voxel);
    const opaline::formats::VdbOutputGrid named{"density", &grid};
    if (const auto status = opaline::formats::write_vdb(argv[1], {&named, 1}); !status) {
        std::fprintf(stderr, "%s\n", status.error().diagnostics.front().fault.c_str());
        return 1;
    }
    std::size_t active = 0;
    for (const float value : grid.value) {
        active += value > 0 ? 1 : 0;
    }
    std::printf("%zu active voxels, %d x %d x %d bricks\n", active, grid.extent.x, grid.extent.y,
                grid.extent.z);
    return 0;
}
