#include <cstddef>
#include <cstring>

#include "runtime/api_support.h"
#include "runtime/embed_gl/api_gl_support.h"
#include "runtime/embed_gl/saved_state.h"

namespace runtime = opaline::runtime;
using namespace opaline::runtime::api;

extern "C" {

opaline_status opaline_gl_light_volumes(opaline_gl* gl, const opaline_volume_light* volume_light) {
    if (gl == nullptr || volume_light == nullptr) return null_argument();
    const runtime::Reading reading(volume_light->users);
    if (!reading) return busy();
    if (volume_light->asset_id != gl->asset_id) {
        return invalid("the volume light was made for another asset: make one for that handle");
    }
    if (const opaline_status status = check_context(*gl); status != OPALINE_OK) return status;
    return guarded([&] {
        const runtime::SavedState saved(gl->gl);
        if (const opaline_status status = gl->volumes.upload(volume_light->light);
            status != OPALINE_OK) {
            return status;
        }
        return runtime::check_errors(gl->gl, "uploading the light of volumes");
    });
}

opaline_status opaline_gl_get_volumes(const opaline_gl* gl, opaline_gl_volumes* volumes) {
    if (gl == nullptr || volumes == nullptr) return null_argument();
    // Hosts of the first version know nothing of own light.
    const std::size_t size = volumes->struct_size;
    if (size != sizeof(opaline_gl_volumes) && size != offsetof(opaline_gl_volumes, glows)) {
        return invalid("struct_size is not one this library knows");
    }
    opaline_gl_volumes found = gl->volumes.objects();
    found.struct_size = size;
    std::memcpy(volumes, &found, size);
    return OPALINE_OK;
}

}  // extern "C"
