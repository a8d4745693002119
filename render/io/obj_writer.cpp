#include "io/obj_writer.hpp"

#include <algorithm>
#include <charconv>
#include <ostream>
#include <set>

#include "io/plain_name.hpp"
#include "io/texture_writer.hpp"
#include "io/visible_shapes.hpp"

namespace vrut::io {

namespace {

constexpr std::array kClamped{scene::Wrap::clamp, scene::Wrap::clamp};

/// Gives each thing a name of its own.
class UniqueNames {
public:
    std::string unique_name(const std::string& name, scene::Id id, const std::string& otherwise) {
        std::string own = plain_name(name.empty() ? otherwise : name);
        while (!taken_.insert(own).second) own += "_" + std::to_string(id);
        return own;
    }

private:
    std::set<std::string> taken_;
};

class ObjWriter {
public:
    explicit ObjWriter(std::ostream& out) : out_(out) {}

    void begin(const std::string& library) { text("mtllib ").text(library).text("\n").flush(); }

    void write_shape(const ShownShape& shape, const std::string& name, const std::string& material) {
        const scene::Geometry& geometry = *shape.geometry;
        text("o ").text(name).text("\nusemtl ").text(material).text("\n");
        for (const glm::dvec3& position : geometry.positions)
            vector("v", glm::dvec3(shape.world * glm::dvec4(position, 1)));
        for (const glm::vec2& texcoord : geometry.texcoords) vector("vt", glm::dvec2(texcoord));
        write_normals(geometry, glm::dmat3(shape.world));
        write_faces(geometry, glm::determinant(glm::dmat3(shape.world)) < 0);
        positions_ += geometry.positions.size();
        texcoords_ += geometry.texcoords.size();
        normals_ += geometry.normals.size();
        flush();
    }

    /// The files are empty for none; with holes, that of the texture is that of the opacity as well.
    void write_material(const scene::Material& material, const std::string& name,
                        const std::string& texture_file, bool holes, const std::string& normal_file) {
        text("newmtl ").text(name).text("\nillum 2\n");
        vector("Ka", glm::dvec3(material.ambient));
        vector("Kd", glm::dvec3(material.diffuse));
        vector("Ks", glm::dvec3(material.specular));
        vector("Ke", material.metallic_roughness ? glm::dvec3(0) : glm::dvec3(material.emission));
        vector("Ns", glm::dvec1(material.shininess));
        vector("d", glm::dvec1(material.diffuse.a));
        const std::string_view clamp = material.sampler.wraps == kClamped ? "-clamp on " : "";
        if (!texture_file.empty()) text("map_Kd ").text(clamp).text(texture_file).text("\n");
        if (holes) text("map_d ").text(clamp).text(texture_file).text("\n");
        if (const auto& surface = material.metallic_roughness) {
            vector("Pr", glm::dvec1(surface->roughness));
            vector("Pm", glm::dvec1(surface->metallic));
            vector("Pc", glm::dvec1(surface->clear_coat));
        }
        if (!normal_file.empty())
            vector("norm -bm", glm::dvec1(material.normal_scale), " " + std::string(clamp) + normal_file);
        flush();
    }

private:
    ObjWriter& text(std::string_view piece) {
        buffer_ += piece;
        if (buffer_.size() > (1 << 16)) flush();
        return *this;
    }

    void flush() {
        out_ << buffer_;
        buffer_.clear();
    }

    /// A line; `rest` stands at its end.
    template <int N>
    void vector(std::string_view keyword, const glm::vec<N, double>& value, std::string_view rest = {}) {
        text(keyword);
        for (int i = 0; i < N; ++i) {
            char digits[32];
            char* const end =
                std::to_chars(digits, digits + sizeof digits, value[i] + 0.0, std::chars_format::general, 9)
                    .ptr;
            text(" ").text({digits, static_cast<std::size_t>(end - digits)});
        }
        text(rest).text("\n");
    }

    /// By the matrix's cofactors times the sign of its determinant, as they are drawn.
    void write_normals(const scene::Geometry& geometry, const glm::dmat3& m) {
        const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
        const double sign = glm::determinant(m) < 0 ? -1 : 1;
        for (const glm::vec3& normal : geometry.normals) {
            const glm::dvec3 turned = cofactors * glm::dvec3(normal) * sign;
            const double length = glm::length(turned);
            vector("vn", length > 0 ? turned / length : turned);
        }
    }

    /// Under a mirroring matrix corners change their turn, so that the front stays the front.
    void write_faces(const scene::Geometry& geometry, bool mirrored) {
        for (const glm::uvec3& triangle : geometry.triangles) {
            text("f");
            for (int i = 0; i < 3; ++i) write_corner(geometry, triangle[mirrored ? 2 - i : i]);
            text("\n");
        }
    }

    void write_corner(const scene::Geometry& geometry, std::size_t vertex) {
        text(" ").text(std::to_string(positions_ + vertex + 1));
        if (!geometry.texcoords.empty() || !geometry.normals.empty()) text("/");
        if (!geometry.texcoords.empty()) text(std::to_string(texcoords_ + vertex + 1));
        if (!geometry.normals.empty()) text("/").text(std::to_string(normals_ + vertex + 1));
    }

    std::ostream& out_;
    std::string buffer_;
    std::size_t positions_ = 0, texcoords_ = 0, normals_ = 0;  // written before
};

/// For each material and, at last, the default one, its name; empty where no shape has it.
std::vector<std::string> name_materials(const scene::Scene& scene, const std::vector<ShownShape>& shapes) {
    std::vector<std::string> names(scene.materials().size() + 1);
    UniqueNames taken;
    for (const ShownShape& shape : shapes) {
        const std::size_t i =
            shape.material == scene::kNone ? names.size() - 1 : static_cast<std::size_t>(shape.material);
        const scene::Material& material = scene.material(shape.material);
        if (names[i].empty()) names[i] = taken.unique_name(material.name, material.id, "material");
    }
    return names;
}

bool has_holes(const scene::Scene& scene, const scene::Material& material) {
    return material.texture != scene::kNone &&
           scene.textures()[static_cast<std::size_t>(material.texture)].transparent;
}

/// What the file does not hold, and what of it the rule of our reader does not take (assimp/scene.hpp).
void report_lost_shading(const scene::Scene& scene, const scene::Material& material,
                         ConversionWarnings& warnings) {
    warnings.add("a material's two-sided flag is lost");
    if (material.texture != scene::kNone && !material.sampler.repeats() && material.sampler.wraps != kClamped)
        warnings.add("a texture repeats where it was mirrored, or clamped in one direction");
    if (material.texture != scene::kNone && material.sampler.magnification == scene::Magnification::nearest)
        warnings.add("a texture's magnification by the nearest texel is lost");
    if (material.reflectivity > 0) warnings.add("a material's reflectivity is lost");
    if (material.emissive != glm::dvec3(0)) warnings.add("a material's emissive light is lost");
    if (has_holes(scene, material) && material.diffuse.a < 1)
        warnings.add("a textured material's own opacity is written, but not read back");
    if (material.metallic_roughness) {
        if (material.occlusion_roughness_metallic_texture != scene::kNone)
            warnings.add("a material's metallic-roughness texture is lost");
        return;
    }
    if (glm::distance(glm::dvec3(material.ambient), 0.1 * glm::dvec3(material.diffuse)) > 1e-6)
        warnings.add(
            "a material's ambient colour is written, but read back as a tenth of its diffuse colour");
    if (material.shininess < 1 && glm::dvec3(material.specular) != glm::dvec3(0))
        warnings.add("a shininess below 1 is written, but read back as another or none");
}

void report_lost_materials(const scene::Scene& scene, const std::vector<std::string>& names,
                           ConversionWarnings& warnings) {
    for (std::size_t i = 0; i + 1 < names.size(); ++i) {
        const scene::Material& material = scene.materials()[i];
        if (names[i].empty()) {
            warnings.add("an unused material is omitted");
            continue;
        }
        if (names[i] != material.name)
            warnings.add("a material is renamed: OBJ names are unique single words");
        report_lost_shading(scene, material, warnings);
    }
}

void report_lost_geometry(const std::vector<ShownShape>& shapes, ConversionWarnings& warnings) {
    std::set<const scene::Geometry*> written;
    for (const ShownShape& shape : shapes) {
        if (!written.insert(shape.geometry).second)
            warnings.add("a geometry that several nodes share is written once for each node");
        if (!shape.geometry->colors.empty()) warnings.add("vertex colours are lost");
        const auto& positions = shape.geometry->positions;
        const auto is_single = [&](const glm::dvec3& position) {
            const glm::dvec4 world = shape.world * glm::dvec4(position, 1);
            return glm::dvec4(glm::vec4(world)) == world;
        };
        if (!std::all_of(positions.begin(), positions.end(), is_single))
            warnings.add("a geometry's positions are rounded to nine digits");
    }
}

}  // namespace

void write_obj(const scene::Scene& scene, const std::filesystem::path& path, base::OutputFiles& files,
               ConversionWarnings& warnings, const WriteProgress& progress) {
    const auto shapes = shown_shapes(scene, warnings);
    const auto materials = name_materials(scene, shapes);
    report_lost_nodes(scene, warnings);
    report_lost_tree(scene, warnings);
    report_lost_materials(scene, materials, warnings);
    report_lost_geometry(shapes, warnings);
    const auto texture_files = write_textures(scene, path, files);
    const std::string library = plain_name(path.stem().string()) + ".mtl";
    files.write(path.parent_path() / library, [&](std::ostream& out) {
        for (std::size_t i = 0; i < materials.size(); ++i) {
            if (materials[i].empty()) continue;
            const scene::Material& material =
                scene.material(i + 1 < materials.size() ? static_cast<scene::Index>(i) : scene::kNone);
            const auto file_of = [&](scene::Index texture) {
                return texture == scene::kNone ? "" : texture_files[static_cast<std::size_t>(texture)];
            };
            ObjWriter(out).write_material(material, materials[i], file_of(material.texture),
                                          has_holes(scene, material), file_of(material.normal_texture));
        }
    });
    files.write(path, [&](std::ostream& out) {
        ObjWriter writer(out);
        UniqueNames names;
        writer.begin(library);
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            const scene::Node& node = scene.nodes()[static_cast<std::size_t>(shapes[i].node)];
            const std::string name = names.unique_name(node.name, node.id, "node");
            if (name != node.name) warnings.add("a node is renamed: OBJ names are unique single words");
            const scene::Index material = shapes[i].material;
            writer.write_shape(shapes[i], name,
                               materials[material == scene::kNone ? materials.size() - 1
                                                                  : static_cast<std::size_t>(material)]);
            if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(shapes.size()));
        }
    });
}

}  // namespace vrut::io
