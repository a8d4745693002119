#pragma once

#include <EGL/egl.h>

#include <memory>
#include <optional>
#include <vector>

#include "gl/framebuffer.hpp"
#include "gl/handles.hpp"
#include "math/bounds.hpp"
#include "plan/view.hpp"
#include "scene/image.hpp"

namespace vrut::bench {

/// A second GL context on the current context's display, so that neither sees the other's state.
class SecondContext {
public:
    /// Makes the second context current. Throws std::runtime_error where there is none.
    SecondContext();
    /// Makes the first context current again.
    ~SecondContext();
    SecondContext(const SecondContext&) = delete;
    SecondContext& operator=(const SecondContext&) = delete;
    void use_first() const { use(first_); }
    void use_second() const { use(second_); }

private:
    void use(EGLContext context) const;
    EGLDisplay display_ = eglGetCurrentDisplay();
    EGLContext first_ = eglGetCurrentContext(), second_ = EGL_NO_CONTEXT;
};

struct BareMesh;

/// What glDrawElements is given for one draw. Vertices are in world space, relative to the scene's centre.
struct BareDraw {
    std::shared_ptr<const BareMesh> mesh;
    scene::Material material;
    bool cull_backfaces = true, two_sided = false;
    math::Bounds bounds;  ///< in world space, relative to the scene's centre
};

/// How a bare loop orders its work.
enum class BareMethod {
    plain,           ///< draw after draw
    front_to_back,   ///< draws by the distance of their boxes' centres
    depth_pre_pass,  ///< depth of everything first, then colours where the depth is equal
    strips,          ///< the lower and then the upper half of the picture, with frustum culling for each
    flushes,         ///< glFlush after every kFlushedTriangles
    multisampled,    ///< 4 samples a pixel, resolved by the driver
};

/// The least that GL must do for a picture of opaque surfaces under a headlight: no scene graph, no plan.
/// The shading is that of the program's surface shader, at each pixel.
class BareLoop {
public:
    static constexpr GLsizei kFlushedTriangles = 50'000;

    /// `center`, in world space, is where the vertices' coordinates start.
    BareLoop(int width, int height, const glm::dvec3& center);
    /// Draws, waits, and reads the picture back into `image`.
    void draw(const std::vector<BareDraw>& draws, const plan::View& view, BareMethod method,
              scene::Image& image);

private:
    void bind_multisampled();
    void resolve();
    void clear(const plan::View& view);
    void draw_all(const std::vector<const BareDraw*>& draws, bool flush);
    void draw_depth(const std::vector<const BareDraw*>& draws);
    void draw_strips(const std::vector<const BareDraw*>& draws, const plan::View& view);

    int width_, height_;
    glm::dvec3 center_;
    glm::dmat4 view_from_local_{1};
    gl::Framebuffer target_;
    gl::GlRenderbuffer sampled_color_, sampled_depth_;
    gl::GlFramebuffer sampled_;
    gl::GlProgram surface_, depth_;
};

/// One draw for each part of a view's plan.
std::vector<BareDraw> draws_of_parts(const plan::View& view, const glm::dvec3& center);
/// The same triangles, with one draw for each material and its cull mode.
std::vector<BareDraw> draws_of_materials(const plan::View& view, const glm::dvec3& center);

}  // namespace vrut::bench
