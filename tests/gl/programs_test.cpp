// Programs are compiled while a scene is loaded, so that no frame waits for them.
#include "renderer_fixture.hpp"

using namespace vrut;

namespace {

/// What each material, light and background can ask of programs.
scene::SceneParts everything() {
    scene::SceneParts parts;
    parts.textures.resize(7);
    for (scene::Texture& texture : parts.textures) texture.image = {2, 2, std::vector<std::uint8_t>(16, 200)};
    scene::Geometry textured = sphere(0.5, 8);
    textured.texcoords.resize(textured.positions.size(), {0.5, 0.5});
    scene::Geometry colored = textured;
    colored.colors.resize(colored.positions.size(), {0.5, 1, 0.5});
    parts.geometries = {quad(3), sphere(0.6, 8), textured, box({0.3, 0.3, 0.3}), colored};
    const auto add = [&](const scene::Geometry* geometry, double alpha, double reflectivity,
                         scene::Index texture, const glm::dvec3& place) {
        const auto material = static_cast<scene::Index>(parts.materials.size());
        parts.materials.push_back(material_of({0.7, 0.5, 0.3}, {0.5, 0.5, 0.5}, 20));
        parts.materials.back().diffuse.a = alpha;
        parts.materials.back().reflectivity = reflectivity;
        parts.materials.back().texture = texture;
        const auto index = static_cast<scene::Index>(geometry - parts.geometries.data());
        parts.nodes.push_back({scene::Node{material + 1,
                                           {},
                                           scene::NodeType::geometry,
                                           scene::kNone,
                                           {},
                                           true,
                                           moved_by(place),
                                           scene::GeometryData{index, material}},
                               0});
    };
    const scene::Geometry* const shapes = parts.geometries.data();
    add(shapes, 1, 0.8, scene::kNone, {0, 0, -1});         // a mirror
    add(shapes + 1, 1, 0, scene::kNone, {-1.2, 0, -1});    // its plane cuts this
    add(shapes + 1, 1, 0.5, scene::kNone, {1.2, 0, 0.5});  // chrome
    add(shapes + 2, 1, 0, 6, {0, 1, 0});
    add(shapes + 2, 0.5, 0.5, 6, {0, -1, -1});
    add(shapes + 3, 0.5, 0, scene::kNone, {0.2, -0.9, -0.9});
    add(shapes + 3, 0.4, 0.3, scene::kNone, {-0.4, 0, 1});
    add(shapes + 4, 1, 0.5, 6, {0.8, 0.8, 0});
    add(shapes + 4, 0.5, 0.5, scene::kNone, {-0.8, -0.8, 0.5});
    add(shapes + 1, 1, 0, scene::kNone, {-0.8, 0.8, 0.2});
    parts.materials.back().emissive = {0.1, 0.1, 0};
    add(shapes + 2, 0.5, 0.5, 6, {0.8, -0.8, 0.2});
    parts.materials.back().emissive = {0, 0.2, 0};
    parts.materials.back().emissive_texture = 6;
    const auto make_metallic = [&](scene::Index metal_texture, scene::Index normal_texture) {
        scene::Material& material = parts.materials.back();
        material.metallic_roughness = {0.5, 0.4, 0.5};
        material.occlusion_roughness_metallic_texture = metal_texture;
        material.normal_texture = normal_texture;
    };
    add(shapes + 1, 1, 0, scene::kNone, {-0.4, 0.9, 0.6});
    make_metallic(scene::kNone, scene::kNone);
    add(shapes, 1, 0.5, scene::kNone, {0.1, 0.2, -1.5});  // a mirror
    make_metallic(scene::kNone, scene::kNone);
    add(shapes + 2, 0.5, 0, 6, {0.4, 0.9, 0.6});
    make_metallic(6, scene::kNone);
    add(shapes + 2, 1, 0, 6, {0.4, -0.9, 0.6});
    parts.materials.back().normal_texture = 6;
    scene::Id id = 20;
    using Type = scene::LightData::Type;
    for (const Type type : {Type::point, Type::directional, Type::spot}) {
        scene::LightData light;
        light.type = type;
        parts.nodes.push_back(
            {scene::Node{
                 id++, {}, scene::NodeType::light, scene::kNone, {}, true, moved_by({0, 0, 3}), light},
             0});
    }
    scene::BackgroundData background;
    background.cube_map.emplace();
    background.cube_textures = {0, 1, 2, 3, 4, 5};
    parts.nodes.push_back(
        {scene::Node{id, {}, scene::NodeType::background, scene::kNone, {}, true, glm::dmat4(1), background},
         0});
    return parts;
}

/// In every drawing mode, with or without a selection.
template <class Draw>
void in_all_modes(plan::View view, const Draw& draw) {
    for (const plan::DrawMode mode : {plan::DrawMode::realistic, plan::DrawMode::stylized})
        for (const bool wireframe : {false, true})
            for (const scene::Index selected : {scene::kNone, 3, 6}) {
                CAPTURE(static_cast<int>(mode));
                CAPTURE(wireframe);
                CAPTURE(selected);
                view.mode = mode;
                view.wireframe = wireframe;
                view.selected = selected;
                draw(view);
            }
}

}  // namespace

TEST_CASE("no frame of a scene that was uploaded compiles a program") {
    RendererFixture studio;
    auto built = scene::Scene::build(everything());
    REQUIRE(built);
    const auto scene = std::make_shared<const scene::PlacedScene>(scene::place(*std::move(built)));
    plan::View view = view_from({0.5, 0.4, 5});
    view.scene = scene;
    view.markers = markers_at({{0, 0, 1}});
    plan::Methods others{plan::Methods::Lighting::vertex};
    others.texture_filter = plan::Methods::TextureFilter::anisotropic;
    for (const plan::Methods& methods : {plan::Methods(), others}) {
        view.methods = methods;
        studio.renderer().upload(view);
        int frames = 0;
        for (scene::Index node = scene::kNone; node < static_cast<scene::Index>(scene->nodes.size());
             ++node) {
            view.light = {};
            if (node != scene::kNone) {
                if (!std::holds_alternative<scene::LightData>(
                        scene->scene->nodes()[static_cast<std::size_t>(node)].data))
                    continue;
                view.light = scene::light_of(*scene, node);
            }
            for (const bool environment : {false, true}) {
                view.background = {};
                if (environment) view.background.cube_map = {0, 1, 2, 3, 4, 5};
                in_all_modes(view, [&](const plan::View& shown) {
                    studio.draw(scene, shown);
                    CHECK(studio.stats.programs == 0);
                    CHECK(studio.stats.draws > 0);
                    ++frames;
                });
            }
            view.background = {};
            view.background.texture = 6;
            studio.draw(scene, view);
            CHECK(studio.stats.programs == 0);
        }
        CHECK(frames == 96);
    }
}

TEST_CASE("a frame compiles the programs that it is the first to need") {
    RendererFixture studio;
    const auto scene = scene_of({{1, sphere(1, 8), material_of({0.7, 0.5, 0.3}), glm::dmat4(1)}});
    studio.draw(scene, view_from({0, 0, 5}));
    CHECK(studio.stats.programs == 1);
    studio.draw(scene, view_from({0, 1, 5}));
    CHECK(studio.stats.programs == 0);
}
