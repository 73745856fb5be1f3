/* A small GL program: a body under one sun. plain.c is as it was before, embedded.c with a baked
   asset of the body: `diff plain.c embedded.c`. Arguments: PICTURE.hdr, and for embedded BODY.opal.
 */
#include "host.h"
#include "opaline_gl.h"

static const char vertex_text[] =
    "layout(location = 0) in vec3 position;\n"
    "layout(location = 1) in vec3 normal;\n"
    "layout(location = 2) in vec3 radiance;\n"
    "uniform mat4 camera;\n"
    "uniform vec3 eye;\n"
    "out vec3 v_normal, v_to_eye, v_radiance;\n"
    "void main() {\n"
    "    v_normal = normal;\n"
    "    v_radiance = radiance;\n"
    "    v_to_eye = eye - position;\n"
    "    gl_Position = camera * vec4(position, 1.0);\n"
    "}\n";

static const char fragment_text[] =
    "in vec3 v_normal, v_to_eye, v_radiance;\n"
    "out vec4 color;\n"
    "void main() {\n"
    "    vec3 albedo = vec3(1.0);\n"
    "    OpalineView view = opaline_view(v_normal, v_to_eye, false);\n"
    "    color = vec4(opaline_translucent(v_radiance, albedo, view, 1.61), 1.0);\n"
    "}\n";

int main(int argc, char** argv) {
    static vertex vertices[VERTICES];
    static unsigned indices[INDICES];
    const float eye[3] = {0.03f, 0.04f, 0.08f}, sun[3] = {0.80f, 0.36f, -0.48f};
    const char* const output = argc > 1 ? argv[1] : "embedded.hdr";
    float camera[16];
    GLuint array, buffer[2];
    size_t size = 0, library_size = 0;
    const void* bytes = argc > 2 ? map_file(argv[2], &size) : NULL;
    const float sunlight[3] = {46747, 46747,
                               46747}; /* irradiance pi through a disc of 0.53 degrees */
    opaline_asset* asset = NULL;
    opaline_light* light = NULL;
    opaline_gl* gl = NULL;
    opaline_gl_objects objects = {.struct_size = sizeof objects};
    if (!open_context()) {
        fprintf(stderr, "no OpenGL 4.3\n");
        return 1;
    }
    make_body(vertices, indices);
    make_camera(eye, 40, camera);
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(2, buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer[0]);
    glBufferData(GL_ARRAY_BUFFER, sizeof vertices, vertices, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, GL_STATIC_DRAW);
    for (GLuint a = 0; a < 2; ++a) {
        glVertexAttribPointer(a, 3, GL_FLOAT, GL_FALSE, sizeof(vertex), (void*)(12 * (size_t)a));
        glEnableVertexAttribArray(a);
    }
    const char* library = map_file(OPALINE_GLSL_DIR "/opaline_surface.glsl", &library_size);
    if (opaline_asset_load(bytes, size, &asset) || opaline_light_create(asset, &light) ||
        opaline_light_add_sun(light, sun, 0.0046251f, sunlight) ||
        opaline_gl_create(asset, NULL, OPALINE_GL_DEFAULT, &gl) || opaline_gl_relight(gl, light) ||
        opaline_gl_look_from(gl, eye) || opaline_gl_get_objects(gl, &objects)) {
        fprintf(stderr, "%s\n", opaline_last_error());
        return 1;
    }
    glBindBuffer(GL_ARRAY_BUFFER, objects.radiance);
    glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, 16, NULL);
    glEnableVertexAttribArray(2);
    GLuint program = make_program(vertex_text, library, library_size, fragment_text);
    glUniformMatrix4fv(glGetUniformLocation(program, "camera"), 1, GL_FALSE, camera);
    glUniform3fv(glGetUniformLocation(program, "eye"), 1, eye);
    open_picture();
    glDrawElements(GL_TRIANGLES, INDICES, GL_UNSIGNED_INT, NULL);
    return write_picture(output) ? 0 : 1;
}
