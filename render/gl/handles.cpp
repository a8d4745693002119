#include "gl/handles.hpp"

#include <atomic>
#include <cstdio>

#include "base/drawing_errors.hpp"

namespace vrut::gl {

namespace {

std::atomic<long> live_objects{0};

std::string name_of_error(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_CONTEXT_LOST:
            return "GL_CONTEXT_LOST";
        default:
            return "GL error " + std::to_string(error);
    }
}

/// Errors of earlier commands are thrown before anything is allocated.
template <class Allocate>
void allocate_or_throw(Allocate allocate, const std::string& what) {
    throw_on_gl_error("to draw");
    allocate();
    throw_on_gl_error("for " + what);
}

std::string mebibytes_of(const char* what, std::size_t bytes) {
    char text[40];
    std::snprintf(text, sizeof text, "%.1f MiB of ", static_cast<double>(bytes) / (1 << 20));
    return text + std::string(what);
}

std::string of_size(const char* what, int width, int height) {
    return what + (" of " + std::to_string(width)) + "x" + std::to_string(height);
}

GlBuffer make_storage(const char* what, const void* data, std::size_t bytes, GLbitfield flags) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    GlBuffer buffer(name);
    allocate_or_throw([&] { glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), data, flags); },
                      mebibytes_of(what, bytes));
    return buffer;
}

}  // namespace

long live_gl_objects() { return live_objects; }

GLenum take_gl_error() {
    constexpr int kMaxErrors = 100;  // a lost context may return errors forever
    GLenum result = GL_NO_ERROR;
    for (int i = 0; i < kMaxErrors; ++i) {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR) break;
        if (result == GL_NO_ERROR || error == GL_OUT_OF_MEMORY) result = error;
    }
    return result;
}

void throw_on_gl_error(const std::string& purpose) {
    const GLenum error = take_gl_error();
    if (error == GL_NO_ERROR) return;
    if (error == GL_OUT_OF_MEMORY) throw base::OutOfMemory("the graphics driver has no memory " + purpose);
    throw base::GlError("OpenGL reports " + name_of_error(error) + " where it was asked " + purpose);
}

namespace detail {
void count_gl_object(long change) { live_objects += change; }
void destroy_buffer(GLuint name) { glDeleteBuffers(1, &name); }
void destroy_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
void destroy_renderbuffer(GLuint name) { glDeleteRenderbuffers(1, &name); }
void destroy_texture(GLuint name) { glDeleteTextures(1, &name); }
void destroy_sampler(GLuint name) { glDeleteSamplers(1, &name); }
void destroy_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
void destroy_query(GLuint name) { glDeleteQueries(1, &name); }
void destroy_shader(GLuint name) { glDeleteShader(name); }
void destroy_program(GLuint name) { glDeleteProgram(name); }
}  // namespace detail

GlBuffer make_buffer(const char* what, const void* data, std::size_t bytes) {
    return make_storage(what, data, bytes, 0);
}

GlBuffer make_dynamic_buffer(const char* what, std::size_t bytes) {
    return make_storage(what, nullptr, bytes, GL_DYNAMIC_STORAGE_BIT);
}

GlBuffer make_readback_buffer(const char* what, std::size_t bytes) {
    return make_storage(
        what, nullptr, bytes,
        GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT | GL_CLIENT_STORAGE_BIT);
}

GlVertexArray make_vertex_array() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return GlVertexArray(name);
}

GlRenderbuffer make_renderbuffer(GLenum format, int width, int height) {
    GLuint name = 0;
    glCreateRenderbuffers(1, &name);
    GlRenderbuffer renderbuffer(name);
    allocate_or_throw([&] { glNamedRenderbufferStorage(name, format, width, height); },
                      of_size("a picture", width, height) + " pixels");
    return renderbuffer;
}

GlTexture make_texture(GLenum format, int width, int height) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    GlTexture texture(name);
    allocate_or_throw([&] { glTextureStorage2D(name, 1, format, width, height); },
                      of_size("a picture", width, height) + " pixels");
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

GlTexture make_mipmapped_texture(GLenum target, GLenum format, int width, int height, int levels) {
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    GlTexture texture(name);
    allocate_or_throw([&] { glTextureStorage2D(name, levels, format, width, height); },
                      of_size("a texture", width, height) + " texels");
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return texture;
}

GlSampler make_clamping_sampler() {
    GLuint name = 0;
    glCreateSamplers(1, &name);
    GlSampler sampler(name);
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return sampler;
}

GlFramebuffer make_framebuffer() {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    return GlFramebuffer(name);
}

GlQuery make_query(GLenum target) {
    GLuint name = 0;
    glCreateQueries(target, 1, &name);
    return GlQuery(name);
}

}  // namespace vrut::gl
