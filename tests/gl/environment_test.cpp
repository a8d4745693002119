#include "expected_texture.hpp"
#include "reference/reference.hpp"
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

std::array<scene::Image, 6> six(int size, scene::Image (*make)(int, int, unsigned) = cloudy) {
    std::array<scene::Image, 6> images;
    for (unsigned i = 0; i < 6; ++i) images[i] = make(size, size, 10 * (i + 1));
    return images;
}

/// One part, and a panorama for it to reflect.
std::shared_ptr<const scene::PlacedScene> scene_of(const Part& part,
                                                   const std::array<scene::Image, 6>& images) {
    scene::SceneParts parts;
    for (const scene::Image& image : images) parts.textures.push_back({"face.png", image, false});
    parts.materials = {part.material};
    parts.geometries = {part.geometry};
    parts.nodes = {{scene::Node{part.id,
                                {},
                                scene::NodeType::geometry,
                                scene::kNone,
                                {},
                                true,
                                part.matrix,
                                scene::GeometryData{0, 0}},
                    0}};
    return std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
}

/// What a triangle of the part shows at the place where rays meet its plane.
struct SphereFacet {
    glm::dvec3 corners[3]{}, normals[3]{};
    double front = 1;  ///< -1 where the matrix turns triangles round

    SphereFacet(const Part& part, const glm::uvec3& triangle) {
        const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(glm::dmat3(part.matrix)));
        if (glm::determinant(glm::dmat3(part.matrix)) < 0) front = -1;
        const auto& positions = part.geometry.positions;
        const glm::dvec3 face = glm::cross(positions[triangle[1]] - positions[triangle[0]],
                                           positions[triangle[2]] - positions[triangle[0]]);
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 normal =
                part.geometry.normals.empty() ? face : glm::dvec3(part.geometry.normals[triangle[k]]);
            corners[k] = glm::dvec3(part.matrix * glm::dvec4(positions[triangle[k]], 1));
            normals[k] = glm::normalize(normal_matrix * normal);
        }
    }

    struct SphereHit {
        double t = 0;
        bool inside = false;
        glm::dvec3 point{0}, normal{0};
    };
    SphereHit meet(const glm::dvec3& eye, const glm::dvec3& ray) const {
        const glm::dvec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0];
        const glm::dvec3 p = glm::cross(ray, ac), from_a = eye - corners[0], q = glm::cross(from_a, ab);
        const double determinant = glm::dot(ab, p);
        const double u = glm::dot(from_a, p) / determinant, v = glm::dot(ray, q) / determinant;
        const double t = glm::dot(ac, q) / determinant;
        return {t, determinant * front > 0 && u >= 0 && v >= 0 && u + v <= 1 && t > 0, eye + ray * t,
                glm::normalize(normals[0] * (1 - u - v) + normals[1] * u + normals[2] * v)};
    }
};

class Chrome {
public:
    Chrome(const Part& part, const std::array<scene::Image, 6>& images, const plan::View& view)
        : panorama_(images), view_(view), material_(part.material) {
        for (const glm::uvec3& triangle : part.geometry.triangles) facets_.emplace_back(part, triangle);
    }

    /// None where a corner of the pixel misses the part, or meets another face of it than the centre does.
    std::optional<glm::dvec3> at(double x, double y) const {
        const SphereFacet* facet = nearest(x, y);
        for (const double dx : {-0.49, 0.49})
            for (const double dy : {-0.49, 0.49}) {
                const SphereFacet* other = nearest(x + dx, y + dy);
                if (!facet || !other) return std::nullopt;
                if (glm::dot(facet->normals[0], other->normals[0]) < 0.1) return std::nullopt;
            }
        const SphereFacet::SphereHit met = facet->meet(view_.camera.eye, ray_through(view_, x, y));
        const glm::dvec3 own = phong(material_, view_.light, view_.camera.eye, met.point, met.normal);
        constexpr double kStep = 1e-4;
        const auto change = [&](double dx, double dy) {
            return (reflected(*facet, x + dx, y + dy) - reflected(*facet, x - dx, y - dy)) / (2 * kStep);
        };
        return glm::mix(own, panorama_.at(reflected(*facet, x, y), change(kStep, 0), change(0, -kStep)),
                        material_.reflectivity);
    }

private:
    const SphereFacet* nearest(double x, double y) const {
        const SphereFacet* found = nullptr;
        double t = std::numeric_limits<double>::infinity();
        for (const SphereFacet& facet : facets_) {
            const SphereFacet::SphereHit met = facet.meet(view_.camera.eye, ray_through(view_, x, y));
            if (!met.inside || met.t >= t) continue;
            t = met.t;
            found = &facet;
        }
        return found;
    }
    glm::dvec3 reflected(const SphereFacet& facet, double x, double y) const {
        const glm::dvec3 ray = ray_through(view_, x, y);
        return glm::normalize(glm::reflect(ray, facet.meet(view_.camera.eye, ray).normal));
    }

    ExpectedEnvironment panorama_;
    plan::View view_;
    scene::Material material_;
    std::vector<SphereFacet> facets_;
};

scene::Material chrome(double reflectivity) {
    scene::Material material = material_of({0.3, 0.2, 0.1}, {0.5, 0.5, 0.5}, 20);
    material.reflectivity = reflectivity;
    return material;
}

plan::View in_panorama(plan::View view) {
    view.background.cube_map = {0, 1, 2, 3, 4, 5};
    return view;
}

TextureMismatch check(const Part& part, const std::array<scene::Image, 6>& images, const plan::View& view,
                      RendererFixture& studio) {
    const Chrome expected(part, images, view);
    const scene::Image image = studio.draw(scene_of(part, images), in_panorama(view));
    return deviation(image, [&](double x, double y) { return expected.at(x, y); });
}

}  // namespace

TEST_CASE("a chrome ball reflects the panorama") {
    RendererFixture studio;
    for (const int size : {1, 4, 64, 512})
        for (const double reflectivity : {0.25, 1.0}) {
            CAPTURE(size);
            CAPTURE(reflectivity);
            const Part ball{1, sphere(1, 12), chrome(reflectivity),
                            moved_by({1, -0.5, 0.3}) * turned_by(40, {0, 1, 0})};
            plan::View view = view_from({2.5, 1.5, 3.5}, {1, -0.5, 0.3});
            const TextureMismatch off = check(ball, six(size), view, studio);
            CHECK(off.pixels > 500);
            CHECK(off.rms <= 1);
        }
}

TEST_CASE("a small chrome ball reflects the panorama minified, to its rim") {
    RendererFixture studio;
    // Of more triangles than pixels along its rim.
    const auto scene = scene_of({1, sphere(1, 24), chrome(1), glm::dmat4(1)}, six(128));
    for (const glm::ivec2& size : {glm::ivec2(64, 48), glm::ivec2(24, 18)}) {
        CAPTURE(size.x);
        plan::View view = in_panorama(view_from({1, 1, 5}));
        view.width = size.x;
        view.height = size.y;
        view.scene = scene;
        const reference::ReferenceImage expected = reference::trace(view);
        const TextureMismatch off =
            deviation(studio.draw(scene, view), [&](double px, double py) -> std::optional<glm::dvec3> {
                const auto at = static_cast<std::size_t>(view.height - 1 - static_cast<int>(py)) *
                                    static_cast<std::size_t>(view.width) +
                                static_cast<std::size_t>(px);
                if (expected.node[at] == scene::kNone) return std::nullopt;
                return expected.color[at];
            });
        CHECK(off.pixels > 50);
        CHECK_MESSAGE(off.worst <= 5, off.where);
    }
}

TEST_CASE("flat faces of a reflective box reflect the panorama, turned and mirrored as it may be") {
    RendererFixture studio;
    const std::array<scene::Image, 6> images = six(32, noise);
    for (const double x : {1.0, -1.0}) {
        const Part part{1, box({1, 0.7, 0.8}), chrome(0.6), turned_by(30, {0, 1, 0}) * scaled_by({x, 1, 1})};
        const TextureMismatch off = check(part, images, view_from({2, 1.5, 3}), studio);
        CHECK(off.pixels > 500);
        CHECK_MESSAGE(off.worst <= 3, off.where);
    }
}

TEST_CASE("a surface's own colour is clamped before the panorama is mixed in") {
    RendererFixture studio;
    scene::Material bright = chrome(0.5);
    bright.emission = {3, 3, 3, 1};
    scene::Image grey;
    grey.resize(1, 1);
    grey.rgba = {51, 51, 51, 255};
    std::array<scene::Image, 6> images;
    images.fill(grey);
    const scene::Image image = studio.draw(scene_of({1, sphere(1, 8), bright, glm::dmat4(1)}, images),
                                           in_panorama(view_from({0, 0, 3})));
    CHECK(pixel_of(image, 48, 32) == glm::ivec3(153));
}

TEST_CASE("what reflects no panorama is plain, and pays nothing for it") {
    RendererFixture studio;
    const std::array<scene::Image, 6> images = six(8);
    const plan::View plain = view_from({1, 1, 4});
    const auto picture = [&](const scene::Geometry& geometry, double reflectivity, const plan::View& view) {
        return studio.draw(scene_of({1, geometry, chrome(reflectivity), glm::dmat4(1)}, images), view);
    };
    const scene::Geometry ball = sphere(1, 8);
    const scene::Image matte = picture(ball, 0, plain);
    const long objects = gl::live_gl_objects();
    CHECK(picture(ball, 0.5, plain).rgba == matte.rgba);
    CHECK(gl::live_gl_objects() == objects);
    CHECK(studio.stats.uploads == 1);
    plan::View stylized = in_panorama(plain);
    stylized.mode = plan::DrawMode::stylized;
    CHECK(picture(ball, 0.5, stylized).rgba == picture(ball, 0, stylized).rgba);
    CHECK(picture(ball, 0.5, in_panorama(plain)).rgba != picture(ball, 0, in_panorama(plain)).rgba);
    // One pass for the background, one for the ball.
    CHECK(studio.stats.passes == 2);
}

TEST_CASE("the reference renderer sees the same textures, backgrounds and reflections") {
    RendererFixture studio;
    scene::SceneParts parts;
    for (const scene::Image& image : six(128)) parts.textures.push_back({"face.png", image, false});
    parts.textures.push_back({"board.png", cloudy(200, 133), false});
    scene::Image lace = cloudy(60, 40);
    for (std::size_t i = 3; i < lace.rgba.size(); i += 4) lace.rgba[i] = lace.rgba[i - 1];
    parts.textures.push_back({"lace.png", lace, true});
    parts.geometries = {sphere(0.8, 16), quad(3), box({0.4, 0.4, 0.4}), quad(0.7)};
    for (const glm::dvec3& position : parts.geometries[1].positions)
        parts.geometries[1].texcoords.emplace_back(position * 0.7 + 0.1);
    for (const glm::dvec3& position : parts.geometries[3].positions)
        parts.geometries[3].texcoords.emplace_back(position * 1.3);
    parts.materials = {chrome(0.8), material_of({1, 1, 1}, {0.2, 0.2, 0.2}, 10), chrome(0.5), chrome(0.3)};
    parts.materials[1].texture = 6;
    parts.materials[3].texture = 7;
    parts.materials[3].diffuse.a = 0.8;
    const glm::dmat4 places[] = {moved_by({0, 0.8, 0}), turned_by(-90, {1, 0, 0}),
                                 moved_by({1.3, 0.4, 0.6}) * turned_by(30, {0, 1, 0}),
                                 moved_by({-0.5, 0.7, 1.5})};
    for (scene::Index i = 0; i < 4; ++i)
        parts.nodes.push_back({scene::Node{i + 1,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           places[i],
                                           scene::GeometryData{i, i}},
                               0});
    plan::View view = view_from({2, 1.7, 4}, {0, 0.4, 0});
    view.width = 240;
    view.height = 160;
    view.scene = std::make_shared<scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts))));
    for (const bool all_around : {true, false}) {
        view.background = {};
        if (all_around)
            view.background.cube_map = {0, 1, 2, 3, 4, 5};
        else
            view.background.texture = 6;
        const reference::ReferenceImage reference = reference::trace(view);
        const auto at = [&](int x, int y) {
            return static_cast<std::size_t>(view.height - 1 - y) * static_cast<std::size_t>(view.width) +
                   static_cast<std::size_t>(x);
        };
        const TextureMismatch off =
            deviation(studio.draw(view.scene, view), [&](double px, double py) -> std::optional<glm::dvec3> {
                const int x = static_cast<int>(px), y = static_cast<int>(py);
                if (x == 0 || y == 0 || x == view.width - 1 || y == view.height - 1) return std::nullopt;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx)
                        if (reference.node[at(x + dx, y + dy)] != reference.node[at(x, y)])
                            return std::nullopt;
                return reference.color[at(x, y)];
            });
        CHECK(off.pixels > 30000);
        CHECK_MESSAGE(off.rms <= 0.5, off.where);
    }
}
