/* A small GL program: a body under one sun. plain.c is as it was before, embedded.c with a baked
   asset of the body: `diff plain.c embedded.c`. Arguments: PICTURE.hdr, and for embedded BODY.opal.
 */
#include "host.h"

static const char vertex_text[] =
    "layout(location = 0) in vec3 position;\n"
    "layout(location = 1) in vec3 normal;\n"
    "uniform mat4 camera;\n"
    "uniform vec3 eye;\n"
    "out vec3 v_normal, v_to_eye;\n"
    "void main() {\n"
    "    v_normal = normal;\n"
    "    v_to_eye = eye - position;\n"
    "    gl_Position = camera * vec4(position, 1.0);\n"
    "}\n";

static const char fragment_text[] =
    "in vec3 v_normal, v_to_eye;\n"
    "uniform vec3 sun;\n"
    "out vec4 color;\n"
    "void main() {\n"
    "    vec3 albedo = vec3(1.0);\n"
    "    color = vec4(albedo * max(dot(normalize(v_normal), sun), 0.0), 1.0);\n"
    "}\n";

int main(int argc, char** argv) {
    static vertex vertices[VERTICES];
    static unsigned indices[INDICES];
    const float eye[3] = {0.03f, 0.04f, 0.08f}, sun[3] = {0.80f, 0.36f, -0.48f};
    const char* const output = argc > 1 ? argv[1] : "plain.hdr";
    float camera[16];
    GLuint array, buffer[2];
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
    GLuint program = make_program(vertex_text, "", 0, fragment_text);
    glUniformMatrix4fv(glGetUniformLocation(program, "camera"), 1, GL_FALSE, camera);
    glUniform3fv(glGetUniformLocation(program, "eye"), 1, eye);
    glUniform3fv(glGetUniformLocation(program, "sun"), 1, sun);
    open_picture();
    glDrawElements(GL_TRIANGLES, INDICES, GL_UNSIGNED_INT, NULL);
    return write_picture(output) ? 0 : 1;
}
