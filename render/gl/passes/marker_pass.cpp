#include "gl/passes/marker_pass.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>

#include "plan/frame_plan.hpp"
#include "scene/colors.hpp"

namespace vrut::gl {

namespace {

enum MarkerUniform : GLint { clip_from_view_at = 0, radius_at = 1, judged_at = 2, color_at = 3 };

constexpr std::size_t kBatch = 256;  // the shader's
constexpr GLuint kPointsBinding = 1;

// Depth is near / distance, so over a plane it is linear in the picture, and over all that is convex it is
// concave: interpolated between texels it is nowhere more than at the point itself, and going away from the
// point it grows by no more than it falls on the other side. In a hollow it goes on growing as it began. What
// grows by more lies before the point. Where the point itself is hidden, everything before it hides it.
constexpr std::string_view kVertexShader = R"(#version 450 core
layout(location = 0) uniform mat4 clip_from_view;
layout(location = 1) uniform float radius;
layout(location = 2) uniform bool judged;
layout(std140, binding = 1) uniform Points { vec4 points[256]; };
layout(binding = 0) uniform sampler2D depth;
flat out vec2 center;
flat out float opacity;

const int kPlaces = 16;
const float kRounding = 1e-5, kHidden = 0.3;

float depth_at(vec2 pixel) {
    ivec2 low = ivec2(floor(pixel - 0.5)), last = textureSize(depth, 0) - 1;
    vec2 part = pixel - 0.5 - low;
    float d[4];
    for (int i = 0; i < 4; ++i)
        d[i] = texelFetch(depth, clamp(low + ivec2(i & 1, i >> 1), ivec2(0), last), 0).r;
    return mix(mix(d[0], d[1], part.x), mix(d[2], d[3], part.x), part.y);
}

// The part of a point's surroundings, as wide as half its sign, that does not lie before it.
float seen(vec2 at, float own, float pixel) {
    float hides = own * (1 + kRounding + 1.5 * pixel);
    bool is_seen = depth_at(at) <= hides;
    int count = is_seen ? 1 : 0;
    for (int i = 0; i < kPlaces; ++i) {
        float angle = i * 2.39996323, away = radius / 2 * sqrt((i + 0.5) / kPlaces);  // evenly over the disc
        vec2 offset = away * vec2(cos(angle), sin(angle));
        float here = depth_at(at + offset), opposite = max(depth_at(at - offset), own / 2);
        float next = max(depth_at(at + offset / away), own);
        bool own_surface = is_seen && (here + opposite <= 2 * hides || here <= mix(own, next, away) + hides - own);
        if (here <= hides || own_surface) ++count;
    }
    return count / float(kPlaces + 1);
}

void main() {
    vec4 clip = clip_from_view * points[gl_InstanceID];
    vec2 size = textureSize(depth, 0);
    center = (clip.xy / clip.w * 0.5 + 0.5) * size;
    float pixel = 2 / (clip_from_view[1][1] * size.y);  // at distance 1
    opacity = judged ? mix(kHidden, 1, seen(center, clip.z / clip.w, pixel)) : 1;
    vec2 corner = center + (radius + 1) * (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2 - 1);
    gl_Position = vec4(corner / size * 2 - 1, 0, 1);
}
)";

constexpr std::string_view kFragmentShader = R"(#version 450 core
layout(location = 1) uniform float radius;
layout(location = 3) uniform vec3 marker_color;
flat in vec2 center;
flat in float opacity;
out vec4 color;

void main() {
    float away = length(gl_FragCoord.xy - center);
    float rim = max(radius / 5, 1);
    float in_sign = clamp(radius + 0.5 - away, 0, 1), in_rim = clamp(away - (radius - rim) + 0.5, 0, 1);
    color = vec4(mix(marker_color, vec3(1), in_rim), in_sign * opacity);
}
)";

}  // namespace

void MarkerPass::draw(std::span<const glm::dvec3> points, MarkerFade fade, const glm::dmat4& clip_from_view,
                      const Framebuffer& target, plan::FrameStats& stats) {
    if (!program_) {
        program_ = make_program(kVertexShader, kFragmentShader);
        empty_vertex_array_ = make_vertex_array();
        points_ = make_dynamic_buffer("markers", kBatch * sizeof(glm::vec4));
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, kPointsBinding, points_.get());
    target.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glTextureBarrier();  // the depth that is read is the target's own
    glDepthMask(GL_FALSE);
    glBindTextureUnit(0, target.depth().get());
    glUseProgram(program_.get());
    glBindVertexArray(empty_vertex_array_.get());
    const glm::mat4 clip(clip_from_view);
    glUniformMatrix4fv(clip_from_view_at, 1, GL_FALSE, glm::value_ptr(clip));
    glUniform1f(radius_at, static_cast<float>(plan::marker_radius(target.height())));
    glUniform1i(judged_at, fade == MarkerFade::by_depth);
    const glm::vec3 color(scene::kMarkerColor);
    glUniform3fv(color_at, 1, glm::value_ptr(color));
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
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    ++stats.passes;
}

}  // namespace vrut::gl
