// What of glass lies on the GPU, without a renderer around it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "gl/context.hpp"
#include "gl/passes/per_pixel_lists_pass.hpp"
#include "gl/programs.hpp"
#include "reference/reference.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

scene::Material lit_glass() {
    scene::Material material = material_of({0.9, 0.5, 0.2}, {0.6, 0.7, 0.8}, 5);
    material.diffuse.a = 0.5;
    return material;
}

/// A pane whose triangles lie there twice, once with normals that lean aside.
scene::Geometry pane_with_coincident_triangles(bool leaning_later) {
    scene::Geometry geometry = quad(1);
    for (int i = 0; i < 4; ++i) {
        geometry.positions.push_back(geometry.positions[static_cast<std::size_t>(i)]);
        geometry.normals.emplace_back(glm::normalize(glm::vec3(0.9, 0, 0.5)));
    }
    const std::vector<glm::uvec3> upright = geometry.triangles;
    for (const glm::uvec3& triangle : upright) geometry.triangles.push_back(triangle + 4U);
    if (!leaning_later)
        std::rotate(geometry.triangles.begin(), geometry.triangles.begin() + 2, geometry.triangles.end());
    return geometry;
}

std::vector<GLuint> contents_of(GLuint buffer) {
    GLint bytes = 0;
    glGetNamedBufferParameteriv(buffer, GL_BUFFER_SIZE, &bytes);
    std::vector<GLuint> words(static_cast<std::size_t>(bytes) / sizeof(GLuint));
    glGetNamedBufferSubData(buffer, 0, bytes, words.data());
    return words;
}

GLuint bound_lists(GLuint binding) {
    GLint buffer = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, binding, &buffer);
    return static_cast<GLuint>(buffer);
}

/// Renames the fragments of all lists as if the GPU had appended them in the opposite order.
void reverse_fragments() {
    constexpr std::size_t kHead = 4, kFragment = 5;
    const GLuint fragments = bound_lists(gl::kFragmentsBinding), heads = bound_lists(gl::kHeadsBinding);
    std::vector<GLuint> words = contents_of(fragments), first = contents_of(heads);
    const GLuint count = words[0];
    REQUIRE(count > 100);
    REQUIRE(kHead + count * kFragment <= words.size());
    const auto renamed = [&](GLuint number) { return number == 0 ? 0 : count + 1 - number; };
    const std::vector<GLuint> before = words;
    for (GLuint number = 1; number <= count; ++number) {
        const auto from = before.begin() + kHead + (number - 1) * kFragment;
        const auto to = words.begin() + kHead + (renamed(number) - 1) * kFragment;
        std::copy_n(from, kFragment, to);
        *to = renamed(*from);  // the next of the list
    }
    const std::size_t pixels = static_cast<std::size_t>(first[2]) * first[3];
    for (std::size_t i = 0; i < pixels; ++i) first[kHead + i] = renamed(first[kHead + i]);
    const auto write = [](GLuint buffer, const std::vector<GLuint>& values) {
        const std::size_t bytes = values.size() * sizeof(GLuint);
        const gl::GlBuffer source = gl::make_buffer("lists", values.data(), bytes);
        glCopyNamedBufferSubData(source.get(), buffer, 0, 0, static_cast<GLsizeiptr>(bytes));
    };
    write(fragments, words);
    write(heads, first);
}

std::vector<std::uint8_t> composited_lists(const plan::View& view, bool reversed) {
    const gl::GlContext context;
    gl::GpuScene scene(view.scene->scene);
    gl::Programs compiled;
    gl::SurfacePrograms programs(compiled);
    gl::PerPixelListsPass pass(compiled);
    plan::FrameStats stats;
    gl::Framebuffer target(view.width, view.height, true);
    gl::set_constant_state();
    target.bind();
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const glm::dmat4 clip =
        math::reversed_clip_from_view(plan::projection_of(view), plan::near_distance(view));
    programs.begin({clip, scene::view_from_world(view.camera)}, view, &scene);
    const std::vector<plan::DrawItem> items = plan::visible_items(view);
    const glm::ivec2 size(view.width, view.height);
    pass.begin(items, scene, clip, size, {{0, 0}, size});
    pass.collect(items, 0, scene, programs, stats);
    if (reversed) reverse_fragments();
    pass.composite(stats);
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * 4);
    target.read(pixels);
    CHECK(gl::take_gl_error() == GL_NO_ERROR);
    return pixels;
}

}  // namespace

TEST_CASE("the order in which the GPU appends fragments does not tell which of equal depth is in front") {
    plan::View view = view_from({0.3, 0.2, 5});
    std::vector<std::vector<std::uint8_t>> pictures;
    for (const bool leaning_later : {true, false}) {
        view.scene = scene_of(
            {{1, pane_with_coincident_triangles(leaning_later), lit_glass(), turned_by(20, {0, 1, 0})}});
        pictures.push_back(composited_lists(view, false));
        CHECK(composited_lists(view, true) == pictures.back());
    }
    CHECK(pictures[0] != pictures[1]);
}

TEST_CASE("of coincident triangles of one pane the later one of the file is in front") {
    RendererFixture studio;
    scene::Material other = lit_glass();
    other.diffuse = {0.1, 0.2, 0.9, 0.5};
    other.two_sided = true;
    std::vector<scene::Image> pictures;
    for (const bool leaning_later : {true, false}) {
        // A pane that crosses it has both sorted at each pixel.
        plan::View view = view_from({0.3, 0.2, 5});
        view.scene = scene_of(
            {{1, pane_with_coincident_triangles(leaning_later), lit_glass(), turned_by(20, {0, 1, 0})},
             {2, quad(1), other, turned_by(-30, {0, 1, 0})}});
        const auto groups = plan::plan_frame(view).scene.transparent;
        REQUIRE(groups.size() == 1);
        REQUIRE(groups[0].exact);
        pictures.push_back(studio.draw(view.scene, view));
        const scene::Image expected = reference::image_of(reference::trace(view));
        int wrong = 0;
        for (std::size_t i = 0; i < expected.rgba.size(); ++i)
            wrong += std::abs(expected.rgba[i] - pictures.back().rgba[i]) > 1;
        CHECK(wrong <= 3 * 4);  // an edge passes within a hair's breadth of a pixel's centre
    }
    CHECK(pictures[0].rgba != pictures[1].rgba);
}

TEST_CASE("items with orders of their own draw their own triangles, which stay on the GPU") {
    const gl::GlContext context;
    plan::View view = view_from({0, 0, 5});
    view.scene = scene_of({{1, sphere(1, 8), lit_glass()}});
    gl::GpuScene scene(view.scene->scene);
    std::vector<plan::DrawItem> items(2, plan::visible_items(view).at(0));
    const auto& triangles = view.scene->scene->geometries()[0].triangles;
    std::vector<unsigned> order(triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    items[0].order = std::make_shared<const std::vector<unsigned>>(order.rbegin(), order.rend());
    std::rotate(order.begin(), order.begin() + 5, order.end());
    items[1].order = std::make_shared<const std::vector<unsigned>>(order);

    std::vector<GLuint> buffers;
    for (const plan::DrawItem& item : items) buffers.push_back(scene.sorted_triangles(item).indices.get());
    for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<GLuint> indices = contents_of(buffers[i]);
        REQUIRE(indices.size() == triangles.size() * 3);
        for (std::size_t k = 0; k < triangles.size(); ++k)
            for (int corner = 0; corner < 3; ++corner)
                CHECK(indices[3 * k + static_cast<std::size_t>(corner)] ==
                      triangles[(*items[i].order)[k]][corner]);
    }
    const int uploads = scene.uploads();
    for (plan::DrawItem& item : items) {
        // The next frame finds the same order anew.
        item.order = std::make_shared<const std::vector<unsigned>>(*item.order);
        scene.sorted_triangles(item);
    }
    CHECK(scene.uploads() == uploads);
}

TEST_CASE("orders take no more than so much of the GPU's memory") {
    const gl::GlContext context;
    plan::View view = view_from({0, 0, 5});
    view.scene =
        scene_of({{1, surface(32, 32, [](double u, double v) { return glm::dvec3(u, v, 0); }), lit_glass()}});
    gl::GpuScene scene(view.scene->scene);
    plan::DrawItem item = plan::visible_items(view).at(0), in_use = item;
    std::vector<unsigned> order(2 * 32 * 32);
    std::iota(order.begin(), order.end(), 0U);
    in_use.order = std::make_shared<const std::vector<unsigned>>(order);
    const std::size_t bytes = order.size() * sizeof(glm::uvec3);
    int uploads = 0;
    for (std::size_t i = 1; i < 2000; ++i) {
        std::swap(order[0], order[i]);
        item.order = std::make_shared<const std::vector<unsigned>>(order);
        scene.sorted_triangles(item);
        scene.sorted_triangles(in_use);
        uploads = scene.uploads();
    }
    CHECK(uploads == 2000 + 1);  // the geometry, and each order once
    CHECK(2000 * bytes > gl::GpuScene::kMaxSortedBytes);
    const auto most = static_cast<long>(gl::GpuScene::kMaxSortedBytes / bytes);
    CHECK(gl::live_gl_objects() <= 2 * most + 4);
}
