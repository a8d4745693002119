#include "io/scene_textures.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "image_bytes.hpp"
#include "temporary_folder.hpp"

using namespace vrut;
namespace fs = std::filesystem;

namespace {

const std::vector<std::uint8_t> kSolid = {10, 20, 30, 255}, kGlass = {10, 20, 30, 254};

scene::Scene read_well(const fs::path& path) {
    auto scene = io::read_scene(path);
    REQUIRE_MESSAGE(scene, scene.error());
    return *std::move(scene);
}

std::string material(int id, const std::string& image) {
    return "material " + std::to_string(id) + " \"M\" image \"" + image + "\" end\n";
}

std::string sky(const std::vector<std::string>& faces) {
    std::string text = "node 8 \"Sky\" background cube-map";
    for (const std::string& face : faces) text += " \"" + face + "\"";
    return text + " end\n";
}

/// A scene in `folder` of one material that names `image`; its only notice, or nothing.
std::string notice_of(const TemporaryFolder& folder, const std::string& image) {
    const scene::Scene scene = read_well(folder.write("cars/car.vrut", "vrut-text 1\n" + material(3, image)));
    REQUIRE(scene.notices().size() <= 1);
    CHECK((scene.materials()[0].texture == scene::kNone) == (scene.notices().size() == 1));
    return scene.notices().empty() ? "" : scene.notices()[0];
}

void check_notice(const std::string& notice, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) CHECK_MESSAGE(notice.find(part) != std::string::npos, notice);
}

const scene::BackgroundData& background(const scene::Scene& scene) {
    return std::get<scene::BackgroundData>(scene.nodes()[static_cast<std::size_t>(scene.find_node(8))].data);
}

}  // namespace

TEST_CASE("pictures come with the scene that names them, each file once") {
    const TemporaryFolder folder;
    folder.write("solid.png", flat_png(2, 3, kSolid));
    folder.write("textures/glass.png", flat_png(4, 4, kGlass));
    fs::create_symlink("textures/glass.png", folder.path() / "link.png");
    const scene::Scene scene = read_well(folder.write(
        "car.vrut",
        "vrut-text 1\n" + material(1, "solid.png") + material(2, "textures/glass.png") +
            material(3, "link.png") + material(4, "./textures/glass.png") + "material 5 \"Plain\" end\n" +
            sky({"link.png", "link.png", "link.png", "textures/glass.png", "link.png", "link.png"})));
    CHECK(scene.notices().empty());
    REQUIRE(scene.textures().size() == 2);
    CHECK(scene.textures()[0].file == "solid.png");
    CHECK(scene.textures()[0].image.width == 2);
    CHECK(scene.textures()[0].image.height == 3);
    CHECK_FALSE(scene.textures()[0].transparent);
    CHECK(scene.textures()[1].transparent);
    const scene::Index wanted[] = {0, 1, 1, 1, scene::kNone};
    for (std::size_t i = 0; i < std::size(wanted); ++i) CHECK(scene.materials()[i].texture == wanted[i]);
    CHECK(scene.is_transparent(scene.materials()[1]));
    REQUIRE(background(scene).cube_textures);
    CHECK(*background(scene).cube_textures == std::array<scene::Index, 6>{1, 1, 1, 1, 1, 1});
}

TEST_CASE("a scene that is named without a folder finds its pictures") {
    const TemporaryFolder folder;
    folder.write("solid.png", flat_png(2, 2, kSolid));
    folder.write("car.vrut", "vrut-text 1\n" + material(1, "solid.png"));
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    const scene::Scene scene = read_well("car.vrut");
    fs::current_path(before);
    CHECK(scene.notices().empty());
    CHECK(scene.textures().size() == 1);
}

TEST_CASE("pictures outside of the scene's folder are never read") {
    const TemporaryFolder folder;
    const fs::path outside = folder.write("outside.png", flat_png(2, 2, kSolid));
    folder.write("cars/inside.png", flat_png(2, 2, kSolid));
    fs::create_symlink("../outside.png", folder.path() / "cars/leads-out.png");
    fs::create_directory_symlink("..", folder.path() / "cars/up");
    fs::create_directory_symlink(folder.path() / "cars", folder.path() / "cars/here");
    CHECK(notice_of(folder, "inside.png").empty());
    CHECK(notice_of(folder, "here/inside.png").empty());
    for (const std::string& name :
         {std::string("../outside.png"), outside.string(), std::string("leads-out.png"),
          std::string("up/outside.png"), std::string("../cars/inside.png"),
          (folder.path() / "cars/inside.png").string()})
        check_notice(notice_of(folder, name),
                     {"car.vrut: material 3 ", "it lies outside of the scene's folder"});
    // A folder whose name only begins like the scene's is another.
    folder.write("cars2/other.png", flat_png(2, 2, kSolid));
    fs::create_symlink("../cars2/other.png", folder.path() / "cars/other.png");
    check_notice(notice_of(folder, "other.png"), {"it lies outside of the scene's folder"});
}

TEST_CASE("a picture that is not where the scene says is found in another folder") {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& name) {
        auto scene = io::read_scene(
            folder.write("cars/car.vrut", "vrut-text 1\n" + material(1, name)), {},
            {.texture_folders = {folder.path() / "none", folder.path() / "maps", folder.path() / "more"}});
        REQUIRE_MESSAGE(scene, scene.error());
        return *std::move(scene);
    };
    folder.write("outside.png", flat_png(2, 2, kSolid));
    folder.write("maps/deep/below.png", flat_png(2, 2, kSolid));
    folder.write("maps/paint.png", flat_png(3, 3, kSolid));
    folder.write("more/paint.png", flat_png(4, 4, kSolid));
    folder.write("more/wheel.png", flat_png(5, 5, kSolid));
    fs::create_symlink("../outside.png", folder.path() / "maps/leads-out.png");
    const std::pair<std::string, int> found[] = {{"paint.png", 3},
                                                 {"old/paint.png", 3},
                                                 {"/home/me/paint.png", 3},
                                                 {"../paint.png", 3},
                                                 {"wheel.png", 5}};
    for (const auto& [name, width] : found) {
        const scene::Scene scene = read(name);
        CHECK(scene.notices().empty());
        REQUIRE(scene.textures().size() == 1);
        CHECK(scene.textures()[0].image.width == width);
        CHECK(fs::path(scene.textures()[0].file).is_absolute());
    }
    for (const std::string name : {"none.png", "below.png", "outside.png", "leads-out.png", "maps/..", "x/"})
        CHECK_MESSAGE(read(name).textures().empty(), name);
    folder.write("cars/paint.png", flat_png(6, 6, kSolid));
    CHECK(read("paint.png").textures()[0].image.width == 6);
}

TEST_CASE("a picture that cannot be read is left out with a notice") {
    const TemporaryFolder folder;
    folder.write("cars/text.png", "no picture");
    folder.write("cars/short.png", flat_png(2, 2, kSolid).substr(0, 50));
    fs::create_directory(folder.path() / "cars/folder.png");
    fs::create_symlink("loop.png", folder.path() / "cars/loop.png");
    check_notice(notice_of(folder, "none.png"),
                 {"car.vrut: material 3 ", "'none.png'", "there is no such file"});
    check_notice(notice_of(folder, "text.png"),
                 {"material 3 ", "'text.png'", "it is none of PNG, JPEG, WebP, TIFF, BMP, GIF and TGA"});
    check_notice(notice_of(folder, "short.png"), {"material 3 ", "'short.png'", "damaged"});
    check_notice(notice_of(folder, "folder.png"), {"material 3 ", "'folder.png'", "not a regular file"});
    check_notice(notice_of(folder, "loop.png"), {"material 3 ", "'loop.png'", "cannot be found"});
    check_notice(notice_of(folder, "text.png/a.png"), {"material 3 ", "'text.png/a.png'"});
    check_notice(notice_of(folder, std::string("a\0b.png", 7)), {"material 3 "});
}

TEST_CASE("a cube map is six squares of one size, or is left out with a notice") {
    const TemporaryFolder folder;
    folder.write("a.png", flat_png(4, 4, kSolid));
    folder.write("b.png", flat_png(8, 8, kSolid));
    folder.write("c.png", flat_png(4, 5, kSolid));
    const auto read = [&](const std::string& third) {
        return read_well(folder.write(
            "car.vrut", "vrut-text 1\n" + sky({"a.png", "a.png", third, "a.png", "a.png", "a.png"})));
    };
    CHECK(background(read("a.png")).cube_textures);
    const std::pair<const char*, const char*> bad[] = {
        {"b.png", "8 x 8"}, {"c.png", "4 x 5"}, {"none.png", "there is no such file"}};
    for (const auto& [third, cause] : bad) {
        const scene::Scene scene = read(third);
        CHECK_FALSE(background(scene).cube_textures);
        REQUIRE(scene.notices().size() == 1);
        check_notice(scene.notices()[0], {"car.vrut: background 8 ", "'" + std::string(third) + "'", cause});
    }
}

TEST_CASE("the pictures of a scene are limited together") {
    const TemporaryFolder folder;
    folder.write("a.png", flat_png(10, 10, kSolid));
    folder.write("b.png", flat_png(10, 10, kSolid));
    folder.write("c.png", flat_png(5, 5, kSolid));
    scene::SceneParts parts;
    parts.materials.resize(4);
    for (std::size_t i = 0; i < 4; ++i) {
        const char* const names[] = {"a.png", "b.png", "c.png", "a.png"};
        parts.materials[i].id = static_cast<scene::Id>(i);
        parts.materials[i].image = names[i];
    }
    io::read_textures(parts, folder.path() / "car.vrut", {}, {}, 150);
    const scene::Index wanted[] = {0, scene::kNone, 1, 0};
    for (std::size_t i = 0; i < 4; ++i) CHECK(parts.materials[i].texture == wanted[i]);
    REQUIRE(parts.notices.size() == 1);
    check_notice(parts.notices[0], {"material 1 ", "'b.png'", "10 x 10", "at most 50"});
}

TEST_CASE("notices of pictures are few; reading can be given up between pictures") {
    const TemporaryFolder folder;
    folder.write("a.png", flat_png(1, 1, kSolid));
    std::string text = "vrut-text 1\n";
    for (int id = 0; id < 100; ++id) text += material(id, "none.png");
    const fs::path path = folder.write("car.vrut", text + material(100, "a.png"));
    const scene::Scene scene = read_well(path);
    REQUIRE(scene.notices().size() == 21);
    check_notice(scene.notices().back(), {"80 more"});
    scene::SceneParts parts;
    parts.materials.resize(1);
    parts.materials[0].image = "a.png";
    struct Stop {};
    CHECK_THROWS_AS(io::read_textures(parts, path, [](double) { throw Stop(); }), Stop);
}

TEST_CASE("materials that see a texture in other ways get copies, and the last of them the texture itself") {
    const scene::Texture glass{"glass.png", {1, 1, {255, 128, 0, 100}}, true};
    const auto materials_of = [](std::initializer_list<scene::Index> textures) {
        std::vector<scene::Material> materials;
        for (const scene::Index texture : textures) materials.emplace_back().texture = texture;
        return materials;
    };
    const io::TextureChange as_it_is, opaque{.opaque = true}, tinted{.factor = {0.5, 1, 1}},
        both{.opaque = true, .factor = {0, 0.25, 1}};
    const auto color_of = [](const std::vector<scene::Texture>& textures, const scene::Material& material) {
        return textures[static_cast<std::size_t>(material.texture)].image.rgba;
    };
    using Color = std::vector<std::uint8_t>;

    std::vector<scene::Texture> textures{glass};
    std::vector<scene::Material> materials = materials_of({0, 0, scene::kNone, 0, 0});
    CHECK(io::change_textures(materials, {both, opaque, tinted, both, as_it_is}, textures));
    CHECK(textures.size() == 3);
    CHECK(color_of(textures, materials[0]) == Color{0, 66, 0, 255});  // light of 0.216, a quarter of it
    CHECK(color_of(textures, materials[1]) == Color{255, 128, 0, 255});
    CHECK(materials[2].texture == scene::kNone);
    CHECK(materials[3].texture == materials[0].texture);
    CHECK(color_of(textures, materials[4]) == glass.image.rgba);
    CHECK(textures[static_cast<std::size_t>(materials[4].texture)].transparent);
    CHECK_FALSE(textures[static_cast<std::size_t>(materials[0].texture)].transparent);

    textures = {glass};
    materials = materials_of({0, 0});
    CHECK(io::change_textures(materials, {tinted, tinted}, textures));
    CHECK(textures.size() == 1);
    CHECK(color_of(textures, materials[0]) == Color{188, 128, 0, 100});  // half the light

    textures = {glass};
    materials[1].texture = scene::kNone;
    materials[1].emissive_texture = 0;  // which sees it as it is
    CHECK(io::change_textures(materials, {tinted, tinted}, textures));
    CHECK(textures.size() == 2);
    CHECK(textures[0].image.rgba == glass.image.rgba);

    textures = {glass};
    materials = materials_of({0, 0, 0});
    CHECK_FALSE(
        io::change_textures(materials, {opaque, tinted, both}, textures, &scene::Material::texture, 2));
    CHECK(textures.size() == 2);
    CHECK(textures[0].image.rgba == glass.image.rgba);  // who gets no copy sees it as it is
}

TEST_CASE("a texture has the sampler of its materials, and a copy for each other ones") {
    constexpr scene::Sampler kClamp{{scene::Wrap::clamp, scene::Wrap::clamp}};
    scene::SceneParts parts;
    parts.textures = {{"a.png", {1, 1, {1, 2, 3, 255}}, false}, {"b.png", {1, 1, {4, 5, 6, 255}}, false}};
    parts.materials.resize(4);
    parts.materials[0].texture = parts.materials[1].texture = parts.materials[2].emissive_texture = 0;
    parts.materials[1].sampler = parts.materials[2].sampler = kClamp;
    parts.materials[2].normal_texture = 1;
    scene::SceneParts no_room = parts;
    CHECK(io::set_samplers(parts));
    REQUIRE(parts.textures.size() == 3);
    CHECK(parts.materials[0].texture == 0);
    CHECK(parts.textures[0].sampler == scene::Sampler());
    CHECK(parts.materials[1].texture == 2);
    CHECK(parts.textures[2].sampler == kClamp);
    CHECK(parts.textures[2].image.rgba == parts.textures[0].image.rgba);
    CHECK(parts.materials[2].emissive_texture == 2);
    CHECK(parts.materials[2].normal_texture == 1);
    CHECK(parts.textures[1].sampler == kClamp);
    CHECK(parts.materials[3].texture == scene::kNone);

    CHECK_FALSE(io::set_samplers(no_room, 2));
    CHECK(no_room.textures.size() == 2);
    CHECK(no_room.materials[1].texture == 0);
    CHECK(no_room.textures[0].sampler == scene::Sampler());
}
