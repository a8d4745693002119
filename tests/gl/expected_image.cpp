#include "expected_image.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vrut {

glm::dvec3 phong(const scene::Material& material, const scene::Light& light, const glm::dvec3& eye,
                 const glm::dvec3& point, const glm::dvec3& normal) {
    const glm::dvec3 to_eye = glm::normalize(eye - point);
    glm::dvec3 to_light = -light.direction;
    double intensity = 1;
    if (light.headlight || light.type != scene::LightData::Type::directional) {
        const glm::dvec3 position = light.headlight ? eye : light.position;
        const glm::dvec3 coefficients =
            light.attenuation == glm::dvec3(0) ? glm::dvec3(1, 0, 0) : light.attenuation;
        const double d = glm::distance(position, point);
        intensity = 1 / std::max(coefficients.x + coefficients.y * d + coefficients.z * d * d, 1e-6);
        to_light = (position - point) / d;
        if (!light.headlight && light.type == scene::LightData::Type::spot) {
            const auto cosine = [](double degrees) { return std::cos(degrees * std::numbers::pi / 180); };
            intensity *= glm::smoothstep(cosine(light.angle / 2), cosine(0.45 * light.angle),
                                         glm::dot(-to_light, light.direction));
        }
    }
    const double lit = std::max(glm::dot(to_light, normal), 0.0);
    const glm::dvec3 reflected = normal * (2 * glm::dot(to_light, normal)) - to_light;
    const double highlight = material.shininess == 0
                                 ? 1
                                 : std::pow(std::max(glm::dot(reflected, to_eye), 0.0), material.shininess);
    const glm::dvec3 light_color(light.color);
    return glm::clamp(glm::dvec3(material.emission) + glm::dvec3(material.ambient) +
                          glm::dvec3(material.diffuse) * light_color * (lit * intensity) +
                          glm::dvec3(material.specular) * light_color * (lit * highlight * intensity),
                      0.0, 1.0);
}

ExpectedImage::ExpectedImage(const scene::PlacedScene& placed, const plan::View& view) : view_(view) {
    const std::vector<bool> shown = scene::shown_nodes(placed, view.camera.eye);
    std::vector<std::size_t> order(shown.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto id = [&](std::size_t i) { return placed.scene->nodes()[i].id; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return id(a) < id(b); });
    for (const std::size_t i : order)
        if (const auto* data = std::get_if<scene::GeometryData>(&placed.scene->nodes()[i].data);
            data && shown[i])
            add(placed, i, *data);
}

void ExpectedImage::add(const scene::PlacedScene& placed, std::size_t node, const scene::GeometryData& data) {
    const scene::Geometry& geometry = placed.scene->geometries()[static_cast<std::size_t>(data.geometry)];
    const scene::Material& material = placed.scene->material(placed.nodes[node].material);
    const glm::dmat4& world = placed.world[node];
    const glm::dmat3 linear(world);
    // Eq. 6.3 itself: test scenes whose matrix has no inverse are judged by hand.
    const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(linear));
    const bool mirrored = glm::determinant(linear) < 0;
    const int smooth_surface = surfaces_++;
    for (const glm::uvec3& indices : geometry.triangles) {
        const auto position = [&](int k) { return geometry.positions[indices[k]]; };
        const glm::dvec3 face = glm::cross(position(1) - position(0), position(2) - position(0));
        ExpectedTriangle triangle{{}, material, smooth_surface, material.two_sided, mirrored, scene::kNone};
        if (material.reflectivity > 0 && placed.scene->plane(data.geometry)) {
            triangle.mirror = static_cast<scene::Index>(node);
            triangle.both_sides = true;
        }
        bool flat = true;
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 normal =
                geometry.normals.empty() ? glm::dvec3(0) : glm::dvec3(geometry.normals[indices[k]]);
            if (normal == glm::dvec3(0))
                normal = face;
            else
                flat = false;
            triangle.corners[k] = {glm::dvec3(world * glm::dvec4(position(k), 1)),
                                   glm::normalize(normal_matrix * normal)};
        }
        if (flat) {
            // Two triangles of one plane are one surface.
            const auto same_plane =
                std::find_if(triangles_.begin(), triangles_.end(), [&](const ExpectedTriangle& other) {
                    return other.surface > smooth_surface &&
                           glm::distance(other.corners[0].normal, triangle.corners[0].normal) < 1e-6;
                });
            triangle.surface = same_plane == triangles_.end() ? surfaces_++ : same_plane->surface;
        }
        triangles_.push_back(triangle);
    }
}

ExpectedImage::Seen ExpectedImage::at(double x, double y) const {
    const scene::Camera& camera = view_.camera;
    const glm::dvec3 view = glm::normalize(camera.focus - camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(view, camera.up)), up = glm::cross(right, view);
    const double half_height = std::tan(camera.fov * std::numbers::pi / 360);
    const double pixel = 2 * half_height / view_.height;
    const glm::dvec3 ray =
        view + right * ((x - view_.width / 2.0) * pixel) + up * ((view_.height / 2.0 - y) * pixel);

    return along(camera.eye, ray, scene::kNone);
}

ExpectedImage::Seen ExpectedImage::along(const glm::dvec3& origin, const glm::dvec3& ray,
                                         scene::Index from_mirror) const {
    scene::Light light = view_.light;
    if (light.headlight) {
        light.headlight = false;
        light.type = scene::LightData::Type::point;
        light.position = view_.camera.eye;
    }
    std::vector<ExpectedHit> hits;
    for (const ExpectedTriangle& triangle : triangles_) {
        if (from_mirror != scene::kNone && triangle.mirror == from_mirror) continue;
        const auto& [a, b, c] = triangle.corners;
        // Möller and Trumbore: origin + t ray = a + u (b - a) + v (c - a)
        const glm::dvec3 ab = b.position - a.position, ac = c.position - a.position;
        const glm::dvec3 p = glm::cross(ray, ac);
        const double determinant = glm::dot(ab, p);
        if (determinant == 0) continue;
        // Counter-clockwise in the geometry's own space, which a mirroring matrix turns clockwise.
        if (!triangle.both_sides && (determinant > 0) == triangle.mirrored) continue;
        const glm::dvec3 from_a = origin - a.position;
        const double u = glm::dot(from_a, p) / determinant;
        const glm::dvec3 q = glm::cross(from_a, ab);
        const double v = glm::dot(ray, q) / determinant, t = glm::dot(ac, q) / determinant;
        if (u < 0 || v < 0 || u + v > 1 || t <= 0) continue;
        const glm::dvec3 point = origin + ray * t;
        glm::dvec3 normal = glm::normalize(a.normal * (1 - u - v) + b.normal * u + c.normal * v);
        if (triangle.both_sides && glm::dot(normal, ray) > 0) normal = -normal;
        const scene::Material& material = triangle.material;
        Seen seen{triangle.surface, phong(material, light, origin, point, normal)};
        if (triangle.mirror != scene::kNone && from_mirror == scene::kNone) {
            const glm::dvec3 face = glm::normalize(glm::cross(ab, ac));
            const Seen there = along(point, glm::reflect(ray, face), triangle.mirror);
            seen.surface = ((seen.surface + 1) * 1000 + there.surface + 1) % 1'000'003;
            seen.color = glm::mix(seen.color, there.color, material.reflectivity);
        }
        hits.push_back({t, seen, material.diffuse.a});
    }
    return composited(std::move(hits));
}

ExpectedImage::Seen ExpectedImage::composited(std::vector<ExpectedHit> hits) const {
    // Of the same depth the later one is in front.
    std::reverse(hits.begin(), hits.end());
    std::stable_sort(hits.begin(), hits.end(),
                     [](const ExpectedHit& a, const ExpectedHit& b) { return a.distance < b.distance; });

    Seen all{-1, glm::dvec3(0)};
    double through = 1;
    const ExpectedHit* before = nullptr;
    for (const ExpectedHit& hit : hits) {
        // A ray through the edge between two triangles meets their surface once.
        if (before && before->seen.surface == hit.seen.surface &&
            hit.distance - before->distance < 1e-9 * hit.distance)
            continue;
        before = &hit;
        all.color += through * hit.alpha * hit.seen.color;
        all.surface = ((all.surface + 1) * 1000 + hit.seen.surface) % 1'000'003;  // one number for each stack
        through *= 1 - hit.alpha;
        if (through <= 0) break;
    }
    all.color += through * view_.background.color;
    return all;
}

std::optional<ExpectedImage::Seen> ExpectedImage::pixel(int x, int y) const {
    const Seen center = at(x + 0.5, y + 0.5);
    for (const double dx : {0.02, 0.98})
        for (const double dy : {0.02, 0.98})
            if (at(x + dx, y + dy).surface != center.surface) return std::nullopt;
    return center;
}

ImageMismatch difference(const ExpectedImage& expected, const scene::Image& image) {
    ImageMismatch result;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto seen = expected.pixel(x, y);
            if (!seen) continue;
            ++result.compared;
            result.surfaces += seen->surface >= 0;
            const glm::ivec3 is = pixel_of(image, x, y), should = bytes_of(seen->color);
            for (int channel = 0; channel < 3; ++channel) {
                const int off = std::abs(is[channel] - should[channel]);
                if (off <= result.worst) continue;
                result.worst = off;
                const auto text = [](const glm::ivec3& c) {
                    return std::to_string(c.r) + " " + std::to_string(c.g) + " " + std::to_string(c.b);
                };
                result.where = "at " + std::to_string(x) + ", " + std::to_string(y) + ": expected " +
                               text(should) + ", found " + text(is);
            }
        }
    return result;
}

glm::ivec3 pixel_of(const scene::Image& image, int x, int y) {
    const std::uint8_t* bytes = image.rgba.data() + (static_cast<std::size_t>(image.height - 1 - y) *
                                                         static_cast<std::size_t>(image.width) +
                                                     static_cast<std::size_t>(x)) *
                                                        4;
    return {bytes[0], bytes[1], bytes[2]};
}

glm::ivec3 bytes_of(const glm::dvec3& color) { return glm::ivec3(glm::floor(color * 255.0 + 0.5)); }

}  // namespace vrut
