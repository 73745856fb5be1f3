/* Loads a baked asset, puts it under a white sky or a sun, and prints the mean outgoing radiance.
       minimal FILE.opal [sun]                                                                    */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "opaline.h"

int main(int argc, char** argv) {
    opaline_asset* asset = NULL;
    opaline_light* light = NULL;
    const float white[3] = {1, 1, 1}, direction[3] = {1, 2, 1}, sun[3] = {5e4f, 5e4f, 5e4f};
    if (argc < 2) {
        fprintf(stderr, "usage: %s FILE.opal [sun]\n", argv[0]);
        return 2;
    }
    if (opaline_asset_load_path(argv[1], &asset) != OPALINE_OK ||
        opaline_light_create(asset, &light) != OPALINE_OK ||
        (argc > 2 && strcmp(argv[2], "sun") == 0
             ? opaline_light_add_sun(light, direction, 0.00465f, sun)
             : opaline_light_set_lat_long(light, white, 1, 1)) != OPALINE_OK) {
        fprintf(stderr, "%s: %s\n", argv[1], opaline_last_error());
        return 3;
    }
    const size_t floats = 3 * (size_t)opaline_asset_receiver_count(asset);
    float* radiance = malloc((floats + 1) * sizeof(float));
    double sum = 0;
    if (opaline_shade(asset, light, OPALINE_SHADE_DEFAULT, radiance, floats) != OPALINE_OK)
        return 3;
    for (size_t i = 0; i < floats; ++i)
        sum += radiance[i];
    printf("%lu receivers, mean radiance %g\n", (unsigned long)(floats / 3),
           floats > 0 ? sum / (double)floats : 0.0);
    free(radiance);
    opaline_light_release(light);
    opaline_asset_release(asset);
    return 0;
}
