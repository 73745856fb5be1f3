/* opaline.h as C sees it: compiled with -std=c99 -pedantic, linked against the shared library. */
#include "opaline.h"

int main(void) {
    opaline_asset* asset = NULL;
    opaline_status status = opaline_asset_load_path(NULL, &asset);
    if (status != OPALINE_INVALID_ARGUMENT || opaline_last_error()[0] == '\0') {
        return 1;
    }
    /* Arrays are made of these: their sizes are part of the interface. */
    if (sizeof(opaline_march_ray) != 32 || sizeof(opaline_march_result) != 24 ||
        sizeof(opaline_sample_point) != 24 || sizeof(opaline_sample_result) != 24) {
        return 3;
    }
    opaline_volume_light* volume_light = NULL;
    if (opaline_asset_volume_count(NULL) != 0 ||
        opaline_volume_light_create(NULL, &volume_light) != OPALINE_INVALID_ARGUMENT ||
        opaline_volumes_march(NULL, volume_light, NULL, NULL, 0, NULL) !=
            OPALINE_INVALID_ARGUMENT) {
        return 4;
    }
    opaline_volume_light_release(volume_light);
    return opaline_version() == OPALINE_VERSION ? 0 : 2;
}
