#include "gl_faults.hpp"

#include <EGL/egl.h>
#include <dlfcn.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

#include "gl/gl.hpp"

namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

std::atomic<int> draws_left{std::numeric_limits<int>::max()}, refused_contexts{0}, refused_threads{0};
std::atomic<bool> lost{false}, told{false}, queries_withheld{false};
std::atomic<int> stalls{0}, calls{0};
std::atomic<std::size_t> copied{0};

std::mutex mutex;  // of what follows
std::map<GLuint, std::size_t> buffers, textures;
std::size_t used = 0, most = kAll;
GLenum error = GL_NO_ERROR, allocation_error = GL_NO_ERROR, draw_error = GL_NO_ERROR;

template <class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// Whether there is room for it; else the error is there.
bool take(std::map<GLuint, std::size_t>& objects, GLuint name, std::size_t bytes) {
    const std::lock_guard lock(mutex);
    if (allocation_error != GL_NO_ERROR || bytes > most - std::min(used, most)) {
        error = allocation_error != GL_NO_ERROR ? allocation_error : GL_OUT_OF_MEMORY;
        return false;
    }
    std::size_t& held = objects[name];  // of another context's, perhaps: then that is forgotten
    used += bytes - std::exchange(held, bytes);
    return true;
}

void give_back(std::map<GLuint, std::size_t>& objects, GLsizei count, const GLuint* names) {
    const std::lock_guard lock(mutex);
    for (GLsizei i = 0; i < count; ++i)
        if (const auto object = objects.extract(names[i])) used -= object.mapped();
}

/// Unless the context is lost by now, or the draw is to fail.
template <class Draw>
void draw_or_fail(Draw draw) {
    ++calls;
    if (draws_left-- == 0) lost = true;
    const std::unique_lock lock(mutex);
    if (const GLenum failure = std::exchange(draw_error, GL_NO_ERROR); failure != GL_NO_ERROR)
        error = failure;
    else if (!lost)
        draw();
}

}  // namespace

namespace vrut::gl_faults {

void reset_after(int draws) { draws_left = draws; }
int draw_calls() { return calls; }
void refuse_contexts(int count) { refused_contexts = count; }
std::size_t memory_used() {
    const std::lock_guard lock(mutex);
    return used;
}
std::size_t bytes_copied() { return copied; }
void limit_memory(std::size_t bytes) {
    const std::lock_guard lock(mutex);
    most = bytes;
}
void fail_allocations(unsigned with) {
    const std::lock_guard lock(mutex);
    allocation_error = with;
}
void fail_draw(unsigned with) {
    const std::lock_guard lock(mutex);
    draw_error = with;
}
void withhold_queries() { queries_withheld = true; }
int query_stalls() { return stalls; }
void refuse_threads(int count) { refused_threads = count; }
void heal() {
    refuse_threads(0);
    reset_after(std::numeric_limits<int>::max());
    refuse_contexts(0);
    limit_memory(kAll);
    fail_allocations(GL_NO_ERROR);
    fail_draw(GL_NO_ERROR);
    queries_withheld = false;
    stalls = 0;
}

}  // namespace vrut::gl_faults

extern "C" {

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                   void* argument) noexcept {
    if (refused_threads > 0) {
        --refused_threads;
        return EAGAIN;
    }
    return real<decltype(pthread_create)>("pthread_create")(thread, attributes, run, argument);
}

EGLContext eglCreateContext(EGLDisplay display, EGLConfig config, EGLContext shared,
                            const EGLint* attributes) {
    if (refused_contexts > 0) {
        --refused_contexts;
        return EGL_NO_CONTEXT;
    }
    lost = told = false;
    return real<decltype(eglCreateContext)>("eglCreateContext")(display, config, shared, attributes);
}

GLenum APIENTRY glGetGraphicsResetStatus() {
    return lost && !told.exchange(true) ? GL_INNOCENT_CONTEXT_RESET : GL_NO_ERROR;
}

void APIENTRY glDrawElements(GLenum mode, GLsizei count, GLenum type, const void* indices) {
    static auto* const draw = real<decltype(glDrawElements)>("glDrawElements");
    draw_or_fail([&] { draw(mode, count, type, indices); });
}

void APIENTRY glDrawElementsBaseVertex(GLenum mode, GLsizei count, GLenum type, const void* indices,
                                       GLint first_vertex) {
    static auto* const draw = real<decltype(glDrawElementsBaseVertex)>("glDrawElementsBaseVertex");
    draw_or_fail([&] { draw(mode, count, type, indices, first_vertex); });
}

void APIENTRY glMultiDrawElementsBaseVertex(GLenum mode, const GLsizei* counts, GLenum type,
                                            const void* const* indices, GLsizei draws,
                                            const GLint* first_vertices) {
    static auto* const draw = real<decltype(glMultiDrawElementsBaseVertex)>("glMultiDrawElementsBaseVertex");
    draw_or_fail([&] { draw(mode, counts, type, indices, draws, first_vertices); });
}

void APIENTRY glMultiDrawElementsIndirect(GLenum mode, GLenum type, const void* draws, GLsizei count,
                                          GLsizei stride) {
    static auto* const draw = real<decltype(glMultiDrawElementsIndirect)>("glMultiDrawElementsIndirect");
    draw_or_fail([&] { draw(mode, type, draws, count, stride); });
}

void APIENTRY glReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
                           void* pixels) {
    static auto* const read = real<decltype(glReadPixels)>("glReadPixels");
    if (!lost) read(x, y, width, height, format, type, pixels);
}

void APIENTRY glGetQueryObjectuiv(GLuint query, GLenum name, GLuint* value) {
    static auto* const get = real<decltype(glGetQueryObjectuiv)>("glGetQueryObjectuiv");
    GLuint available = 0;
    get(query, GL_QUERY_RESULT_AVAILABLE, &available);
    if (name == GL_QUERY_RESULT && (!available || queries_withheld)) ++stalls;
    get(query, name, value);
    if (name == GL_QUERY_RESULT_AVAILABLE && queries_withheld) *value = 0;
}

GLenum APIENTRY glGetError() {
    static auto* const get = real<decltype(glGetError)>("glGetError");
    const std::lock_guard lock(mutex);
    return error != GL_NO_ERROR ? std::exchange(error, GL_NO_ERROR) : get();
}

void APIENTRY glNamedBufferStorage(GLuint buffer, GLsizeiptr size, const void* data, GLbitfield flags) {
    static auto* const store = real<decltype(glNamedBufferStorage)>("glNamedBufferStorage");
    if (data) copied += static_cast<std::size_t>(size);
    if (take(buffers, buffer, static_cast<std::size_t>(size))) store(buffer, size, data, flags);
}

void APIENTRY glNamedBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, const void* data) {
    static auto* const copy = real<decltype(glNamedBufferSubData)>("glNamedBufferSubData");
    copied += static_cast<std::size_t>(size);
    copy(buffer, offset, size, data);
}

void APIENTRY glTextureSubImage2D(GLuint texture, GLint level, GLint x, GLint y, GLsizei width,
                                  GLsizei height, GLenum format, GLenum type, const void* pixels) {
    static auto* const copy = real<decltype(glTextureSubImage2D)>("glTextureSubImage2D");
    copied += 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    copy(texture, level, x, y, width, height, format, type, pixels);
}

void APIENTRY glTextureSubImage3D(GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei width,
                                  GLsizei height, GLsizei depth, GLenum format, GLenum type,
                                  const void* pixels) {
    static auto* const copy = real<decltype(glTextureSubImage3D)>("glTextureSubImage3D");
    copied += 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    copy(texture, level, x, y, z, width, height, depth, format, type, pixels);
}

void APIENTRY glDeleteBuffers(GLsizei count, const GLuint* names) {
    give_back(buffers, count, names);
    real<decltype(glDeleteBuffers)>("glDeleteBuffers")(count, names);
}

void APIENTRY glTextureStorage2D(GLuint texture, GLsizei levels, GLenum format, GLsizei width,
                                 GLsizei height) {
    static auto* const store = real<decltype(glTextureStorage2D)>("glTextureStorage2D");
    const std::size_t texels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (take(textures, texture, 4 * texels)) store(texture, levels, format, width, height);
}

void APIENTRY glDeleteTextures(GLsizei count, const GLuint* names) {
    give_back(textures, count, names);
    real<decltype(glDeleteTextures)>("glDeleteTextures")(count, names);
}

}  // extern "C"
