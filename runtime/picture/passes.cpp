#include "runtime/picture/passes.h"

namespace opaline::runtime {

std::vector<PicturePass> list_passes(bool background, bool volumes, bool layers) {
    std::vector<PicturePass> passes{PicturePass::surfaces};
    if (background) passes.push_back(PicturePass::background);
    if (layers) passes.push_back(PicturePass::layers);
    if (volumes) passes.push_back(PicturePass::volumes);
    return passes;
}

}  // namespace opaline::runtime
