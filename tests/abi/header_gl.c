/* opaline_gl.h as hosts see it: compiled in several dialects, linked to the shared library with GL.
 */
#include "opaline_gl.h"

static void* load(const char* name) {
    (void)name;
    return NULL;
}

int main(void) {
    opaline_gl* gl = NULL;
    opaline_gl_objects objects;
    const opaline_gl_loader loader = load;
    objects.struct_size = sizeof objects;
    if (opaline_gl_create(NULL, loader, OPALINE_GL_WITH_MESH, &gl) != OPALINE_INVALID_ARGUMENT ||
        opaline_last_error()[0] == '\0') {
        return 1;
    }
    if (opaline_gl_relight(gl, NULL) != OPALINE_INVALID_ARGUMENT ||
        opaline_gl_look_from(gl, NULL) != OPALINE_INVALID_ARGUMENT ||
        opaline_gl_get_objects(gl, &objects) != OPALINE_INVALID_ARGUMENT) {
        return 2;
    }
    return opaline_gl_release(gl) == OPALINE_OK ? 0 : 3;
}
