#include "io/vrut/text_writer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>
#include <string_view>
#include <type_traits>

namespace vrut::io {

namespace {

/// To the last bit: a matrix with -0 is none.
bool is_identity(const glm::dmat4& matrix) {
    bool negative = false;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) negative |= std::signbit(matrix[column][row]);
    return matrix == glm::dmat4(1) && !negative;
}

class VrutTextWriter {
public:
    VrutTextWriter(std::ostream& out, const std::vector<std::string>& texture_files)
        : out_(out), texture_files_(texture_files) {}

    void write(const scene::Scene& scene, const std::string& comment) {
        text("vrut-text 1\n");
        write_comment(comment);
        if (scene.unit()) text("unit").number(*scene.unit()).text("\n");
        for (const scene::Material& material : scene.materials()) write_material(material);
        for (const scene::Geometry& geometry : scene.geometries()) write_geometry(geometry);
        for (const scene::Node& node : scene.nodes()) write_node(scene, node);
        flush();
    }

private:
    // --- tokens, each after a space

    VrutTextWriter& text(std::string_view piece) {
        buffer_ += piece;
        if (buffer_.size() > (1 << 16)) flush();
        return *this;
    }

    template <class Number>
    VrutTextWriter& number(Number value) {
        char digits[40];
        char* const last = digits + sizeof digits;
        char* end = std::to_chars(digits, last, value).ptr;
        if constexpr (std::is_same_v<Number, float>) {
            // The reader takes them as a double, which in rare cases rounds to a neighbour.
            double read = 0;
            std::from_chars(digits, end, read);
            if (static_cast<float>(read) != value) end = std::to_chars(digits, last, double{value}).ptr;
        }
        return text(" ").text({digits, static_cast<std::size_t>(end - digits)});
    }

    template <int N, class Number>
    VrutTextWriter& numbers(const glm::vec<N, Number>& value) {
        for (int i = 0; i < N; ++i) number(value[i]);
        return *this;
    }

    VrutTextWriter& string(std::string_view value) {
        std::string quoted = " \"";
        for (const char c : value) {
            if (c == '"' || c == '\\') quoted += '\\';
            quoted += c == '\n' ? ' ' : c;
        }
        return text(quoted + '"');
    }

    void flush() {
        out_ << buffer_;
        buffer_.clear();
    }

    // --- blocks

    void write_comment(std::string_view comment) {
        while (!comment.empty()) {
            const std::size_t end = std::min(comment.find('\n'), comment.size());
            text("# ").text(comment.substr(0, end)).text("\n");
            comment.remove_prefix(std::min(end + 1, comment.size()));
        }
    }

    void write_material(const scene::Material& material) {
        text("\nmaterial").number(material.id).string(material.name);
        text("\n  ambient").numbers(material.ambient);
        text("  diffuse").numbers(material.diffuse);
        text("  specular").numbers(material.specular);
        text("  emission").numbers(material.emission);
        text("\n  shininess").number(material.shininess);
        text("  reflectivity").number(material.reflectivity);
        text("  two-sided").number(material.two_sided ? 1 : 0);
        write_image("image", material.texture, material.image);
        if (material.emissive != glm::dvec3(0)) text("\n  emissive").numbers(material.emissive);
        write_image("emissive-image", material.emissive_texture, material.emissive_image);
        if (const auto& surface = material.metallic_roughness) {
            text("\n  metallic-roughness").number(surface->metallic).number(surface->roughness);
            if (surface->clear_coat > 0) text("  clear-coat").number(surface->clear_coat);
        }
        write_image("occlusion-roughness-metallic-image", material.occlusion_roughness_metallic_texture,
                    material.occlusion_roughness_metallic_image);
        write_image("normal-image", material.normal_texture, material.normal_image);
        if (material.normal_scale != 1) text("\n  normal-scale").number(material.normal_scale);
        if (const auto& [u, v] = material.sampler.wraps; !material.sampler.repeats())
            text("\n  image-wrap ").text(name_of(u)).text(" ").text(name_of(v));
        if (const auto magnification = material.sampler.magnification;
            magnification != scene::Magnification::linear)
            text("\n  image-magnification ").text(name_of(magnification));
        text("\nend\n");
    }

    void write_image(std::string_view member, scene::Index texture, const std::string& own) {
        if (const std::string& image = texture_file(texture, own); !image.empty())
            text("\n  ").text(member).string(image);
    }

    template <class Rows>
    void write_rows(std::string_view name, const Rows& rows) {
        if (rows.empty()) return;
        text("\n  ").text(name).number(rows.size());
        for (const auto& row : rows) text("\n ").numbers(row);
    }

    const std::string& texture_file(scene::Index texture, const std::string& own) const {
        return texture == scene::kNone || texture_files_.empty()
                   ? own
                   : texture_files_[static_cast<std::size_t>(texture)];
    }

    void write_geometry(const scene::Geometry& geometry) {
        text("\ngeometry").number(geometry.id);
        write_rows("vertices", geometry.positions);
        write_rows("normals", geometry.normals);
        write_rows("texcoords", geometry.texcoords);
        write_rows("colors", geometry.colors);
        write_rows("triangles", geometry.triangles);
        text("\nend\n");
    }

    void write_node(const scene::Scene& scene, const scene::Node& node) {
        text("\nnode").number(node.id).string(node.name).text(" ").text(scene::name_of(node.type));
        if (node.parent != scene::kNone)
            text("  parent").number(scene.nodes()[static_cast<std::size_t>(node.parent)].id);
        if (!node.active) text("  active 0");
        if (node.presentation) text("  presentation 1");
        if (!is_identity(node.matrix)) {
            text("\n  matrix");
            for (int row = 0; row < 4; ++row)
                for (int column = 0; column < 4; ++column) number(node.matrix[column][row]);
            text("\n ");
        }
        if (node.hinge) text("  hinge").numbers(node.hinge->axis).number(node.hinge->degrees);
        std::visit([&](const auto& data) { write_data(scene, data); }, node.data);
        text("  end\n");
    }

    // --- what nodes of each type hold

    void write_material_of(const scene::Scene& scene, scene::Index material) {
        if (material != scene::kNone) text("  material").number(scene.material(material).id);
    }

    void write_data(const scene::Scene&, const scene::GroupData&) {}

    void write_data(const scene::Scene& scene, const scene::GeometryData& data) {
        if (data.geometry != scene::kNone)
            text("  geometry").number(scene.geometries()[static_cast<std::size_t>(data.geometry)].id);
        write_material_of(scene, data.material);
    }

    void write_data(const scene::Scene&, const scene::CameraData& camera) {
        text("  eye").numbers(camera.eye).text("  focus").numbers(camera.focus);
        text("  up").numbers(camera.up).text("  fov").number(camera.fov);
        if (camera.look_radius > 0) text("  look").number(camera.look_radius);
    }

    void write_data(const scene::Scene&, const scene::LightData& light) {
        constexpr std::string_view kNames[] = {"point", "directional", "spot"};
        text("  type ").text(kNames[static_cast<std::size_t>(light.type)]);
        text("  color").numbers(light.color).text("  attenuation").numbers(light.attenuation);
        text("  angle").number(light.angle);
    }

    void write_data(const scene::Scene&, const scene::SwitchData& data) {
        text("  active-child").number(data.active_child);
    }

    void write_data(const scene::Scene&, const scene::LodData& lod) {
        if (lod.ranges.empty()) return;
        text("  ranges");
        for (const double range : lod.ranges) number(range);
    }

    void write_data(const scene::Scene& scene, const scene::BackgroundData& background) {
        write_material_of(scene, background.material);
        if (background.only_reflected) text("  only-reflected 1");
        if (!background.cube_map) return;
        text("  cube-map");
        for (std::size_t i = 0; i < 6; ++i)
            string(texture_file(background.cube_textures ? (*background.cube_textures)[i] : scene::kNone,
                                (*background.cube_map)[i]));
    }

    std::ostream& out_;
    const std::vector<std::string>& texture_files_;
    std::string buffer_;
};

}  // namespace

void write_vrut_text(const scene::Scene& scene, std::ostream& out, const std::string& comment,
                     const std::vector<std::string>& texture_files) {
    VrutTextWriter(out, texture_files).write(scene, comment);
}

}  // namespace vrut::io
