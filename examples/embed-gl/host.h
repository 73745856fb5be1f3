/* The host's own engine, as far as a small program has one: a context without a window, a mesh, a
   camera, a program, a picture. Knows nothing of Opaline. */
#ifndef HOST_H
#define HOST_H

#include <EGL/egl.h>
#include <EGL/eglext.h>
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WIDTH = 320, HEIGHT = 240, SUPERSAMPLING = 3 };

static int open_context(void) {
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    EGLDisplay display =
        get_display == NULL ? eglGetDisplay(EGL_DEFAULT_DISPLAY)
                            : get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (!eglInitialize(display, NULL, NULL)) {
        display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
        if (!eglInitialize(display, NULL, NULL)) return 0;
    }
    eglBindAPI(EGL_OPENGL_API);
    return eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE,
                          eglCreateContext(display, NULL, EGL_NO_CONTEXT, version));
}

/* A file's bytes, where the system maps them: aligned to a page. NULL: it cannot be read, and says
   so. */
static const void* map_file(const char* path, size_t* size) {
    struct stat status;
    const int file = open(path, O_RDONLY);
    void* bytes = MAP_FAILED;
    if (file >= 0 && fstat(file, &status) == 0 && status.st_size > 0) {
        *size = (size_t)status.st_size;
        bytes = mmap(NULL, *size, PROT_READ, MAP_PRIVATE, file, 0);
    }
    if (bytes == MAP_FAILED) fprintf(stderr, "%s: %s\n", path, strerror(errno));
    if (file >= 0) close(file);
    return bytes == MAP_FAILED ? NULL : bytes;
}

/* --- A body with bumps, 4 cm across: COLUMNS quads around, ROWS from pole to pole ------------- */

enum {
    COLUMNS = 64,
    ROWS = 32,
    VERTICES = (COLUMNS + 1) * (ROWS + 1),
    INDICES = 6 * COLUMNS * ROWS
};

typedef struct vertex {
    float position[3], normal[3];
} vertex;

static void place_vertex(double u, double v, double p[3]) {
    const double pi = 3.14159265358979, phi = 2 * pi * u, theta = pi * v;
    const double bump = pow(sin(theta), 3) * cos(5 * phi) * cos(6 * theta);
    const double radius = 0.02 * (1 + 0.12 * bump);
    const double ring = v == 0 || v == 1 ? 0 : radius * sin(theta); /* poles are points */
    p[0] = ring == 0 ? 0 : ring * cos(phi);
    p[1] = radius * cos(theta);
    p[2] = ring == 0 ? 0 : -ring * sin(phi);
}

static void make_body(vertex* vertices, unsigned* indices) {
    for (int i = 0; i < VERTICES; ++i) {
        const double h = 1e-4, u = (double)(i % (COLUMNS + 1)) / COLUMNS,
                     v = (double)(i / (COLUMNS + 1)) / ROWS;
        double p[3], a[3], b[3], c[3], d[3], n[3];
        place_vertex(u == 1 ? 0 : u, v, p); /* both ends of a seam are the same point */
        place_vertex(u - h, v, a), place_vertex(u + h, v, b);
        place_vertex(u, v - h, c), place_vertex(u, v + h, d);
        for (int k = 0; k < 3; ++k) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            n[k] = (d[l] - c[l]) * (b[m] - a[m]) - (d[m] - c[m]) * (b[l] - a[l]);
        }
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        const int is_pole = v == 0 || v == 1;
        for (int k = 0; k < 3; ++k) {
            vertices[i].position[k] = (float)p[k];
            vertices[i].normal[k] = (float)(is_pole ? (k == 1 ? 1 - 2 * v : 0) : n[k] / length);
        }
    }
    for (int q = 0; q < COLUMNS * ROWS; ++q) {
        const unsigned a = (unsigned)(q / COLUMNS * (COLUMNS + 1) + q % COLUMNS),
                       b = a + COLUMNS + 1;
        const unsigned quad[6] = {a, b, a + 1, a + 1, b, b + 1};
        memcpy(indices + 6 * q, quad, sizeof quad);
    }
}

/* --- Camera, program, picture ------------------------------------------------------------------
 */

/* Column by column, looking from `eye` at the origin. */
static void make_camera(const float eye[3], float fov_y_degrees, float m[16]) {
    const float distance = sqrtf(eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2]);
    const float back[3] = {eye[0] / distance, eye[1] / distance, eye[2] / distance};
    const float flat = sqrtf(back[0] * back[0] + back[2] * back[2]);
    const float right[3] = {back[2] / flat, 0, -back[0] / flat};
    const float up[3] = {back[1] * right[2], back[2] * right[0] - back[0] * right[2],
                         -back[1] * right[0]};
    const float y = 1 / tanf(fov_y_degrees * 3.14159265f / 360), x = y * HEIGHT / WIDTH;
    const float near = distance / 10, far = distance * 10;
    const float a = (far + near) / (near - far), b = 2 * far * near / (near - far);
    for (int k = 0; k < 3; ++k) {
        m[4 * k] = x * right[k];
        m[4 * k + 1] = y * up[k];
        m[4 * k + 2] = a * back[k];
        m[4 * k + 3] = -back[k];
    }
    m[12] = m[13] = 0;
    m[14] = b - a * distance;
    m[15] = distance;
}

/* `library`: text that comes before the fragment shader's own. */
static GLuint make_program(const char* vertex_text, const char* library, size_t library_size,
                           const char* fragment_text) {
    const char* const version = "#version 430 core\n";
    const char* texts[2][3] = {{version, vertex_text, ""}, {version, library, fragment_text}};
    const GLint sizes[2][3] = {{-1, -1, 0}, {-1, (GLint)library_size, -1}};
    const GLuint program = glCreateProgram();
    for (int stage = 0; stage < 2; ++stage) {
        const GLuint shader = glCreateShader(stage == 0 ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER);
        char log[1000] = "";
        glShaderSource(shader, 3, texts[stage], sizes[stage]);
        glCompileShader(shader);
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        fputs(log, stderr);
        glAttachShader(program, shader);
    }
    glLinkProgram(program);
    glUseProgram(program);
    return program;
}

static void open_picture(void) {
    GLuint framebuffer, renderbuffer[2];
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenRenderbuffers(2, renderbuffer);
    for (int i = 0; i < 2; ++i) {
        glBindRenderbuffer(GL_RENDERBUFFER, renderbuffer[i]);
        glRenderbufferStorage(GL_RENDERBUFFER, i == 0 ? GL_RGBA32F : GL_DEPTH_COMPONENT24,
                              WIDTH * SUPERSAMPLING, HEIGHT * SUPERSAMPLING);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER,
                                  i == 0 ? GL_COLOR_ATTACHMENT0 : GL_DEPTH_ATTACHMENT,
                                  GL_RENDERBUFFER, renderbuffer[i]);
    }
    glViewport(0, 0, WIDTH * SUPERSAMPLING, HEIGHT * SUPERSAMPLING);
    glEnable(GL_DEPTH_TEST);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

/* Radiance, as a Radiance file (.hdr). */
static int write_picture(const char* path) {
    enum { S = SUPERSAMPLING };
    float* samples = malloc(sizeof(float) * 3 * WIDTH * HEIGHT * S * S);
    FILE* file = fopen(path, "wb");
    if (file == NULL || samples == NULL) return 0;
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, WIDTH * S, HEIGHT * S, GL_RGB, GL_FLOAT, samples);
    fprintf(file, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", HEIGHT, WIDTH);
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        float rgb[3] = {0, 0, 0};
        for (int s = 0; s < S * S; ++s) {
            const int x = i % WIDTH * S + s % S, y = (HEIGHT - 1 - i / WIDTH) * S + s / S;
            for (int k = 0; k < 3; ++k)
                rgb[k] += samples[3 * (y * WIDTH * S + x) + k] / (S * S);
        }
        int exponent = 0;
        const float largest = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
        if (largest > 1e-30f) frexpf(largest, &exponent);
        for (int k = 0; k < 3; ++k)
            fputc(largest > 1e-30f ? (int)ldexpf(rgb[k], 8 - exponent) : 0, file);
        fputc(largest > 1e-30f ? exponent + 128 : 0, file);
    }
    free(samples);
    return fclose(file) == 0;
}

#endif
