// opaline.h and opaline.hpp as a C++17 host sees them, linked against the shared library.
#include "opaline.h"
// Twice: the guard holds.
#include "opaline.h"
#include "opaline.hpp"

int main() {
    const opaline::Made<opaline::AssetHandle> asset = opaline::load_asset(nullptr, 0);
    return asset.status == OPALINE_INVALID_ARGUMENT && asset.handle == nullptr ? 0 : 1;
}
