#pragma once

#include <string>
#include <utility>

#include "gl/gl.hpp"

namespace vrut::gl {

/// GL objects that live now, of all kinds: 0 when everything is given back.
long live_gl_objects();

/// Clears all of OpenGL's error flags. GL_OUT_OF_MEMORY if it was among them, as the others may follow from
/// it; else the first; GL_NO_ERROR if none was set.
GLenum take_gl_error();

/// Clears the error flags. Throws OutOfMemory for GL_OUT_OF_MEMORY, and for any other error GlError with its
/// name. `purpose` ends the sentence, as in "for 2.0 MiB of vertices".
void throw_on_gl_error(const std::string& purpose);

namespace detail {
void count_gl_object(long change);
}

/// Owns one GL object: moved, never copied.
template <void (*Destroy)(GLuint)>
class GlHandle {
public:
    GlHandle() = default;
    explicit GlHandle(GLuint name) : name_(name) { detail::count_gl_object(name_ != 0 ? 1 : 0); }
    GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlHandle& operator=(GlHandle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlHandle() {
        if (name_ == 0) return;
        Destroy(name_);
        detail::count_gl_object(-1);
    }

    GLuint get() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

private:
    GLuint name_ = 0;
};

namespace detail {
void destroy_buffer(GLuint name);
void destroy_vertex_array(GLuint name);
void destroy_renderbuffer(GLuint name);
void destroy_texture(GLuint name);
void destroy_sampler(GLuint name);
void destroy_framebuffer(GLuint name);
void destroy_query(GLuint name);
void destroy_shader(GLuint name);
void destroy_program(GLuint name);
}  // namespace detail

using GlBuffer = GlHandle<detail::destroy_buffer>;
using GlVertexArray = GlHandle<detail::destroy_vertex_array>;
using GlRenderbuffer = GlHandle<detail::destroy_renderbuffer>;
using GlTexture = GlHandle<detail::destroy_texture>;
using GlSampler = GlHandle<detail::destroy_sampler>;
using GlFramebuffer = GlHandle<detail::destroy_framebuffer>;
using GlQuery = GlHandle<detail::destroy_query>;
using GlShader = GlHandle<detail::destroy_shader>;
using GlProgram = GlHandle<detail::destroy_program>;

// Whatever holds much throws as throw_on_gl_error().
/// `what`: of which things it holds so many bytes, as in "vertices".
GlBuffer make_buffer(const char* what, const void* data, std::size_t bytes);
/// Without contents, to be written again and again.
GlBuffer make_dynamic_buffer(const char* what, std::size_t bytes);
/// Without contents, to be mapped for reading for as long as it lives.
GlBuffer make_readback_buffer(const char* what, std::size_t bytes);
GlVertexArray make_vertex_array();
GlRenderbuffer make_renderbuffer(GLenum format, int width, int height);
/// Two dimensions, one level, read texel by texel: an image's own.
GlTexture make_texture(GLenum format, int width, int height);
/// With that many levels, read bilinearly from one of them, repeated in both directions; `target` is
/// GL_TEXTURE_2D or GL_TEXTURE_CUBE_MAP.
GlTexture make_mipmapped_texture(GLenum target, GLenum format, int width, int height, int levels);
/// For mipmapped textures: beyond the edges it finds the texels there.
GlSampler make_clamping_sampler();
GlFramebuffer make_framebuffer();
GlQuery make_query(GLenum target);

}  // namespace vrut::gl
