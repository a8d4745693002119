#include "handles.hpp"

#include <atomic>
#include <stdexcept>
#include <string>

namespace vrut {

namespace {
std::atomic<long> live_objects{0};
}

long live_gl_objects() { return live_objects; }

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

GlBuffer make_buffer(const void* data, std::size_t bytes) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    GlBuffer buffer(name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), data, 0);
    return buffer;
}

GlBuffer make_changing_buffer(std::size_t bytes) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    GlBuffer buffer(name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
    return buffer;
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
    glNamedRenderbufferStorage(name, format, width, height);
    return renderbuffer;
}

GlTexture make_texture(GLenum format, int width, int height) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    GlTexture texture(name);
    glTextureStorage2D(name, 1, format, width, height);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

GlTexture make_mipmapped_texture(GLenum target, int width, int height, int levels) {
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    GlTexture texture(name);
    while (glGetError() != GL_NO_ERROR) {
    }
    glTextureStorage2D(name, levels, GL_RGBA8, width, height);
    if (glGetError() != GL_NO_ERROR)
        throw std::runtime_error("no texture of " + std::to_string(width) + "x" + std::to_string(height) +
                                 " texels can be made: the driver refuses it");
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

}  // namespace vrut
