#include "runtime/picture/passes.h"

namespace opaline::runtime {

std::vector<PicturePass> list_passes(bool background) {
    std::vector<PicturePass> passes{PicturePass::surfaces};
    if (background) passes.push_back(PicturePass::background);
    return passes;
}

}  // namespace opaline::runtime
