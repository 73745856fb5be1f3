/* opaline.h as C sees it: compiled with -std=c99 -pedantic, linked against the shared library. */
#include "opaline.h"

int main(void) {
    opaline_asset* asset = NULL;
    opaline_status status = opaline_asset_load(NULL, 0, &asset);
    if (status != OPALINE_INVALID_ARGUMENT || opaline_last_error()[0] == '\0') {
        return 1;
    }
    return opaline_version() == OPALINE_VERSION ? 0 : 2;
}
