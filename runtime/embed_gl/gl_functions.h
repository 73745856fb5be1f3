#pragma once

#include <GL/glcorearb.h>

#include "runtime/opaline_gl.h"

namespace opaline::runtime {

// All that the library calls, in OpenGL 4.3 and OpenGL ES 3.1 alike.
#define OPALINE_GL_CALLS(X)                 \
    X(ActiveTexture, ACTIVETEXTURE)         \
    X(AttachShader, ATTACHSHADER)           \
    X(BindBuffer, BINDBUFFER)               \
    X(BindBufferBase, BINDBUFFERBASE)       \
    X(BindBufferRange, BINDBUFFERRANGE)     \
    X(BindTexture, BINDTEXTURE)             \
    X(BufferData, BUFFERDATA)               \
    X(BufferSubData, BUFFERSUBDATA)         \
    X(CompileShader, COMPILESHADER)         \
    X(CreateProgram, CREATEPROGRAM)         \
    X(CreateShader, CREATESHADER)           \
    X(DeleteBuffers, DELETEBUFFERS)         \
    X(DeleteProgram, DELETEPROGRAM)         \
    X(DeleteShader, DELETESHADER)           \
    X(DeleteTextures, DELETETEXTURES)       \
    X(DispatchCompute, DISPATCHCOMPUTE)     \
    X(GenBuffers, GENBUFFERS)               \
    X(GenTextures, GENTEXTURES)             \
    X(GetError, GETERROR)                   \
    X(GetInteger64i_v, GETINTEGER64I_V)     \
    X(GetInteger64v, GETINTEGER64V)         \
    X(GetIntegeri_v, GETINTEGERI_V)         \
    X(GetIntegerv, GETINTEGERV)             \
    X(GetProgramInfoLog, GETPROGRAMINFOLOG) \
    X(GetProgramiv, GETPROGRAMIV)           \
    X(GetShaderInfoLog, GETSHADERINFOLOG)   \
    X(GetShaderiv, GETSHADERIV)             \
    X(GetString, GETSTRING)                 \
    X(GetUniformuiv, GETUNIFORMUIV)         \
    X(IsProgram, ISPROGRAM)                 \
    X(LinkProgram, LINKPROGRAM)             \
    X(MemoryBarrier, MEMORYBARRIER)         \
    X(PixelStorei, PIXELSTOREI)             \
    X(ProgramUniform1f, PROGRAMUNIFORM1F)   \
    X(ProgramUniform1ui, PROGRAMUNIFORM1UI) \
    X(ProgramUniform2ui, PROGRAMUNIFORM2UI) \
    X(ProgramUniform3f, PROGRAMUNIFORM3F)   \
    X(ShaderSource, SHADERSOURCE)           \
    X(TexImage2D, TEXIMAGE2D)               \
    X(TexImage3D, TEXIMAGE3D)               \
    X(TexParameteri, TEXPARAMETERI)         \
    X(TexStorage2D, TEXSTORAGE2D)           \
    X(TexSubImage2D, TEXSUBIMAGE2D)         \
    X(UseProgram, USEPROGRAM)

/// The functions of the host's context; nothing is linked to.
struct GlFunctions {
#define OPALINE_GL_POINTER(name, type) PFNGL##type##PROC name = nullptr;
    OPALINE_GL_CALLS(OPALINE_GL_POINTER)
#undef OPALINE_GL_POINTER
    PFNGLGETGRAPHICSRESETSTATUSPROC GetGraphicsResetStatus = nullptr;  ///< where there is one
    bool is_es = false;

    /// What shaders begin with.
    const char* shader_head() const;
};

/// `loader` NULL: that of EGL or GLX, whichever of them the program has loaded and has a context
/// current. Statuses: as opaline_gl_create.
opaline_status load_gl_functions(opaline_gl_loader loader, GlFunctions& gl);

/// ok, or the status of the GL errors since the last check, and what was being done.
opaline_status check_errors(const GlFunctions& gl, const char* doing);

/// Errors that the host left.
void drop_errors(const GlFunctions& gl);

}  // namespace opaline::runtime
