#include "gl/passes/marker_pass.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>

#include "gl/passes/drawing.hpp"
#include "plan/frame_plan.hpp"
#include "scene/style.hpp"

namespace vrut::gl {

namespace {

enum MarkerUniform : GLint {
    marker_clip_at = 0,
    marker_radius_at = 1,
    marker_judged_at = 2,
    marker_color_at = 3
};

constexpr std::size_t kBatch = 256;  // the shader's
constexpr GLuint kPointsBinding = 1;

}  // namespace

void MarkerPass::draw(std::span<const glm::dvec3> points, MarkerFade fade, const glm::dmat4& clip_from_view,
                      const Framebuffer& target, plan::FrameStats& stats) {
    if (!points_) {
        empty_vertex_array_ = make_vertex_array();
        points_ = make_dynamic_buffer("markers", kBatch * sizeof(glm::vec4));
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, kPointsBinding, points_.get());
    target.bind();
    set_scissor({});
    PipelineState state;
    state.depth_test = false;
    state.depth_write = false;
    state.blend = PipelineState::Blend::alpha;
    apply(state);
    glTextureBarrier();  // the depth that is read is the target's own
    glBindTextureUnit(0, target.depth().get());
    programs_.use(FixedProgram::marker);
    glBindVertexArray(empty_vertex_array_.get());
    const glm::mat4 clip(clip_from_view);
    glUniformMatrix4fv(marker_clip_at, 1, GL_FALSE, glm::value_ptr(clip));
    glUniform1f(marker_radius_at, static_cast<float>(plan::marker_radius(target.height())));
    glUniform1i(marker_judged_at, fade == MarkerFade::by_depth);
    const glm::vec3 color(scene::kMarkerColor);
    glUniform3fv(marker_color_at, 1, glm::value_ptr(color));
    for (std::size_t first = 0; first < points.size(); first += kBatch) {
        const std::size_t count = std::min(points.size() - first, kBatch);
        std::array<glm::vec4, kBatch> batch{};
        for (std::size_t i = 0; i < count; ++i) batch[i] = glm::vec4(glm::vec3(points[first + i]), 1);
        glNamedBufferSubData(points_.get(), 0, static_cast<GLsizeiptr>(count * sizeof(glm::vec4)),
                             batch.data());
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
        ++stats.draws;
    }
    glBindTextureUnit(0, 0);
    ++stats.passes;
}

}  // namespace vrut::gl
