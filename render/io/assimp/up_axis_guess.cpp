#include "io/assimp/up_axis_guess.hpp"

#include <algorithm>
#include <initializer_list>
#include <sstream>
#include <string>

#include "base/file_bytes.hpp"
#include "io/read_scene.hpp"

namespace vrut::io {

namespace {

/// Its words in small letters, each between single spaces.
std::string words_of(std::string_view text) {
    std::string words = " ";
    for (const char c : text) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        if (letter)
            words += static_cast<char>(c | 32);
        else if (words.back() != ' ')
            words += ' ';
    }
    return words + ' ';
}

bool has_one_of(std::string_view text, std::initializer_list<std::string_view> parts) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](std::string_view part) { return text.find(part) != std::string_view::npos; });
}

/// The comments at the head of a file, as words_of(); of STL, all of its head.
std::string comments_of(const std::filesystem::path& path, bool stl) {
    constexpr std::uintmax_t kStlHead = 80, kHead = 4096;
    auto file = base::FileReader::open(path);
    if (!file) return {};
    std::string head(static_cast<std::size_t>(std::min(file->size(), stl ? kStlHead : kHead)), '\0');
    if (!file->read(head.data(), head.size())) return {};
    if (stl) return words_of(head);
    std::istringstream lines(std::move(head));
    std::string comments;
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("#") || line.starts_with("comment ") || line.starts_with("obj_info "))
            comments += words_of(line);
    return comments;
}

/// Blender from 2.5 on writes STL and PLY with its own axes unless it is told otherwise, but OBJ with y for
/// up.
bool comments_tell(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    const std::string comments = comments_of(path, extension == ".stl");
    return has_one_of(comments, {" z up ", " up z ", " up axis z ", " z axis up ", " zup ", " z is up "}) ||
           (extension != ".obj" && has_one_of(comments, {" exported from blender ", " created by blender "}));
}

const math::Bounds* bounds_of(const scene::SceneParts& parts, const scene::Node& node) {
    const auto* data = std::get_if<scene::GeometryData>(&node.data);
    return data ? &parts.geometries[static_cast<std::size_t>(data->geometry)].bounds : nullptr;
}

/// Three wheels or more have their centres in a plane of one z.
bool wheels_tell(const scene::SceneParts& parts) {
    constexpr double kFlat = 0.05;
    math::Bounds centers;
    std::size_t wheels = 0;
    for (const auto& part : parts.nodes) {
        const std::string name = words_of(part.node.name);
        const math::Bounds* bounds = bounds_of(parts, part.node);
        if (!bounds || !has_one_of(name, {"wheel", "tyre", " tire"}) || has_one_of(name, {"steer"})) continue;
        centers.add(bounds->center());
        ++wheels;
    }
    if (wheels < 3) return false;
    const glm::dvec3 size = centers.max - centers.min;
    return size.z < kFlat * std::min(size.x, size.y);
}

/// The whole stands on z = 0, and its middle lies on the z axis.
bool ground_tells(const scene::SceneParts& parts) {
    constexpr double kNear = 0.005, kFlat = 0.1;
    math::Bounds all;
    for (const auto& part : parts.nodes)
        if (const math::Bounds* bounds = bounds_of(parts, part.node)) all.add(*bounds);
    if (all.empty()) return false;
    const glm::dvec3 size = all.max - all.min, center = all.center();
    return size.z > kFlat * std::max(size.x, size.y) && std::abs(all.min.z) <= kNear * size.z &&
           std::abs(center.x) <= kNear * size.x && std::abs(center.y) <= kNear * size.y;
}

}  // namespace

bool seems_z_up(const scene::SceneParts& parts, const std::filesystem::path& path) {
    return comments_tell(path) || wheels_tell(parts) || ground_tells(parts);
}

}  // namespace vrut::io
