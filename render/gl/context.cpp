#include "gl/context.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "gl/framebuffer.hpp"
#include "gl/shader_program.hpp"
#include "gl/shader_sources.hpp"

namespace vrut::gl {

struct GlContext::DeviceCandidate {
    EGLDeviceEXT device = EGL_NO_DEVICE_EXT;  // none: the surfaceless platform
    int index = -1;
    bool software = false;
    std::string name() const {
        return index < 0 ? "EGL surfaceless platform" : "EGL device " + std::to_string(index);
    }
};

struct GlContext::Display {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;

    Display() = default;
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;
    ~Display() {
        if (display == EGL_NO_DISPLAY) return;
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
        eglTerminate(display);
        eglReleaseThread();
    }
};

namespace {

bool has_word(const char* list, std::string_view word) {
    for (std::string_view rest = list ? list : ""; !rest.empty();) {
        const std::size_t end = std::min(rest.find(' '), rest.size());
        if (rest.substr(0, end) == word) return true;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
}

template <class Function>
Function egl_function(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

std::vector<EGLDeviceEXT> all_devices() {
    const auto query = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    EGLint count = 0;
    if (!query || !query(0, nullptr, &count) || count <= 0) return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (!query(count, devices.data(), &count)) return {};
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

/// llvmpipe allocates tens of megabytes of triangle data per image. By default glibc returns them to the
/// kernel each time, and the kernel must zero them again.
void keep_freed_memory() {
#ifdef __GLIBC__
    constexpr int kKept = 256 << 20;
    mallopt(M_TRIM_THRESHOLD, kKept);
    mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that glibc chooses itself, until one of the two is set
#endif
}

bool is_software(EGLDeviceEXT device) {
    const auto query = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    return query && has_word(query(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

std::string gl_string(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text ? reinterpret_cast<const char*>(text) : "";
}

/// NVIDIA's name for the message that a program is compiled again at its first draw in another state of GL,
/// which no one can tell beforehand.
constexpr GLuint kRecompiledByNvidia = 131218;

void APIENTRY collect_message(GLenum, GLenum type, GLuint id, GLenum severity, GLsizei length,
                              const GLchar* text, const void* user) {
    if (type == GL_DEBUG_TYPE_PERFORMANCE && id == kRecompiledByNvidia) return;
    if (severity != GL_DEBUG_SEVERITY_HIGH && severity != GL_DEBUG_SEVERITY_MEDIUM) return;
    auto* messages = static_cast<std::vector<std::string>*>(const_cast<void*>(user));
    messages->emplace_back(text, static_cast<std::size_t>(length));
}

/// One that says when the driver has reset itself, and that reads nothing beyond its buffers; or, where the
/// driver has no such, any. None has no version 4.5.
EGLContext create_context(EGLDisplay display, bool debug) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                   4,
                                   EGL_CONTEXT_MINOR_VERSION,
                                   5,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_CONTEXT_OPENGL_DEBUG,
                                   debug ? EGL_TRUE : EGL_FALSE,
                                   EGL_NONE};
    std::vector<EGLint> robust = attributes;
    robust.insert(robust.end() - 1,
                  {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE, EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                   EGL_LOSE_CONTEXT_ON_RESET});
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, robust.data());
    if (context == EGL_NO_CONTEXT)
        context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    return context;
}

/// Draws a triangle over the left half of a small image and looks at both halves.
void check_drawing() {
    constexpr int kSize = 16;
    Framebuffer framebuffer(kSize, kSize);
    const GlProgram program =
        make_program(shader_source("check_drawing.vert"), shader_source("check_drawing.frag"));
    const GlVertexArray vertex_array = make_vertex_array();
    framebuffer.bind();
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glClearColor(1, 1, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glUseProgram(program.get());
    glBindVertexArray(vertex_array.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::array<std::uint8_t, std::size_t{kSize} * kSize * 4> pixels{};
    framebuffer.read(pixels);
    glUseProgram(0);
    const std::array<std::uint8_t, 4> left{51, 102, 153, 255}, right{255, 255, 255, 255};
    const auto pixel = [&](std::size_t x) {
        return pixels.data() + (std::size_t{kSize} / 2 * kSize + x) * 4;
    };
    if (glGetError() != GL_NO_ERROR || !std::equal(left.begin(), left.end(), pixel(3)) ||
        !std::equal(right.begin(), right.end(), pixel(12)))
        throw std::runtime_error("what it draws does not read back right");
}

}  // namespace

GlContext::GlContext(const GlOptions& options) {
    std::vector<DeviceCandidate> candidates;
    const std::vector<EGLDeviceEXT> devices = all_devices();
    for (std::size_t i = 0; i < devices.size(); ++i)
        candidates.push_back({devices[i], static_cast<int>(i), is_software(devices[i])});
    if (options.device) {
        if (*options.device < 0 || static_cast<std::size_t>(*options.device) >= candidates.size())
            throw std::runtime_error("there is no EGL device " + std::to_string(*options.device) +
                                     "; EGL lists " + std::to_string(candidates.size()) + ", counted from 0");
        candidates = {candidates[static_cast<std::size_t>(*options.device)]};
    } else {
        std::stable_partition(candidates.begin(), candidates.end(),
                              [](const DeviceCandidate& c) { return !c.software; });
        candidates.push_back({});
    }

    for (const DeviceCandidate& candidate : candidates) {
        try {
            make_current(candidate, options.debug);
            check_drawing();
            describe(candidate);
            return;
        } catch (const std::exception& error) {
            display_.reset();
            rejected_.push_back(candidate.name() + ": " + error.what());
        }
    }
    std::string tried;
    for (const std::string& sentence : rejected_) tried += (tried.empty() ? "" : "; ") + sentence;
    throw std::runtime_error(
        "no EGL device can draw with OpenGL 4.5 (" + tried +
        "); install a driver, or Mesa's software one: apt-get install libegl-mesa0 libgl1-mesa-dri");
}

GlContext::~GlContext() = default;

bool GlContext::lost() const {
    const GLenum status = glGetGraphicsResetStatus();
    // Some drivers that know nothing of resets answer anything.
    return status == GL_GUILTY_CONTEXT_RESET || status == GL_INNOCENT_CONTEXT_RESET ||
           status == GL_UNKNOWN_CONTEXT_RESET;
}

void GlContext::make_current(const DeviceCandidate& candidate, bool debug) {
    const auto get_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (!get_display) throw std::runtime_error("EGL has no platform displays");
    auto display = std::make_unique<Display>();
    display->display = candidate.index < 0
                           ? get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
                           : get_display(EGL_PLATFORM_DEVICE_EXT, candidate.device, nullptr);
    if (display->display == EGL_NO_DISPLAY) throw std::runtime_error("has no display");
    if (!eglInitialize(display->display, nullptr, nullptr)) throw std::runtime_error("does not initialise");
    const char* extensions = eglQueryString(display->display, EGL_EXTENSIONS);
    if (!has_word(extensions, "EGL_KHR_surfaceless_context") ||
        !has_word(extensions, "EGL_KHR_no_config_context"))
        throw std::runtime_error("has no contexts without a surface");
    if (!eglBindAPI(EGL_OPENGL_API)) throw std::runtime_error("has no OpenGL");
    display->context = create_context(display->display, debug);
    if (display->context == EGL_NO_CONTEXT) throw std::runtime_error("has no OpenGL 4.5 core context");
    if (!eglMakeCurrent(display->display, EGL_NO_SURFACE, EGL_NO_SURFACE, display->context))
        throw std::runtime_error("its context cannot be made current");
    display_ = std::move(display);
    if (debug) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(collect_message, &messages_);
    }
}

void GlContext::describe(const DeviceCandidate& candidate) {
    const std::string renderer = gl_string(GL_RENDERER);
    description_ = candidate.name() + ": " + renderer + ", OpenGL " + gl_string(GL_VERSION);
    // The surfaceless platform does not say which device it took.
    software_ = candidate.software || renderer.find("llvmpipe") != std::string::npos ||
                renderer.find("softpipe") != std::string::npos;
    if (software_) keep_freed_memory();
    GLint texture = 0, renderbuffer = 0, viewport[2] = {0, 0};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &renderbuffer);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    max_size_ = std::min({texture, renderbuffer, viewport[0], viewport[1]});
}

std::vector<std::string> GlContext::take_messages() { return std::exchange(messages_, {}); }

}  // namespace vrut::gl
