#include "scenes/library.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include "temporary_folder.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
namespace fs = std::filesystem;

namespace {

const std::string kScene = "vrut-text 1\nnode 0 \"Room\" root end\n";

}  // namespace

TEST_CASE("SHA-256 is that of the known texts") {
    const TemporaryFolder folder;
    CHECK(sha256_of(folder.write("empty", "")) ==
          "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    CHECK(sha256_of(folder.write("abc", "abc")) ==
          "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    CHECK(sha256_of(folder.write("a", std::string(1'000'000, 'a'))) ==
          "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    CHECK_THROWS(sha256_of(folder.path() / "none"));
    CHECK_THROWS(sha256_of(folder.path()));
}

TEST_CASE("a long file is read in blocks") {
    const TemporaryFolder folder;  // sha256sum of 3 MiB and one byte of zeros
    CHECK(sha256_of(folder.write("long", std::string((3U << 20) + 1, '\0'))) ==
          "5983281b51c767c831104f52c95e4075f27e6f4fa8dd0526e3929f79176a1217");
}

TEST_CASE("a digest that nobody wants any more is not finished") {
    const TemporaryFolder folder;
    const fs::path file = folder.write("zeros.vrut", "");
    fs::resize_file(file, std::uintmax_t{4} << 40);  // which takes an hour
    std::stop_source stop;
    stop.request_stop();
    CHECK_THROWS_WITH(sha256_of(file, stop.get_token()), (file.string() + " is no longer read").c_str());
    CHECK_FALSE(load_scene(file, "zeros"));  // what it begins with is no scene
}

TEST_CASE("scenes are found by name, in folders below, too") {
    const TemporaryFolder folder;
    const fs::path room = folder.write("room.vrut", kScene), deep = folder.write("a/b/deep.vrut", kScene);
    const SceneLibrary library(folder.path());
    CHECK(library.find("room.vrut") == fs::canonical(room));
    CHECK(library.find("a/b/deep.vrut") == fs::canonical(deep));
    CHECK_FALSE(library.find("a/../room.vrut").has_value());  // which stays inside
    CHECK(library.find("./room.vrut") == fs::canonical(room));
}

TEST_CASE("nothing outside of the folder is found, however it is named") {
    const TemporaryFolder outer;
    outer.write("secret.vrut", kScene);
    outer.write("scenes/room.vrut", kScene);
    outer.write("scenes-not/near.vrut", kScene);
    const fs::path folder = outer.path() / "scenes";
    fs::create_symlink(outer.path() / "secret.vrut", folder / "link.vrut");
    fs::create_directory_symlink(outer.path(), folder / "up");
    fs::create_symlink(folder / "room.vrut", folder / "inside.vrut");
    const SceneLibrary library(folder);
    for (const std::string& name :
         {std::string("../secret.vrut"), std::string("x/../../secret.vrut"), std::string(".."),
          std::string("../scenes-not/near.vrut"), (outer.path() / "secret.vrut").string(),
          (folder / "room.vrut").string(), std::string("link.vrut"), std::string("up/secret.vrut"),
          std::string("none.vrut"), std::string("."), std::string(), std::string("room.vrut/"),
          std::string("room.vrut\0.png", 14)}) {
        INFO(name);
        const auto found = library.find(name);
        REQUIRE_FALSE(found);
        CHECK(found.error().starts_with("there is no scene '"));
    }
    CHECK(library.find("inside.vrut") == fs::canonical(folder / "room.vrut"));
    CHECK(library.find("up/scenes/room.vrut") == fs::canonical(folder / "room.vrut"));
}

TEST_CASE("the folder itself may be behind a link, and may go") {
    const TemporaryFolder outer;
    const fs::path room = outer.write("real/room.vrut", kScene);
    fs::create_directory_symlink(outer.path() / "real", outer.path() / "link");
    const SceneLibrary library(outer.path() / "link");
    CHECK(library.find("room.vrut") == fs::canonical(room));
    fs::remove_all(outer.path() / "real");
    CHECK(library.names().empty());
    REQUIRE_FALSE(library.find("room.vrut"));
    CHECK(library.find("room.vrut").error().find("cannot be read") != std::string::npos);
}

TEST_CASE("without a folder there is nothing to open") {
    CHECK(SceneLibrary().names().empty());
    REQUIRE_FALSE(SceneLibrary().find("room.vrut"));
    CHECK(SceneLibrary().find("room.vrut").error() ==
          "this server has no folder of scenes to open: start it with --scenes");
}

TEST_CASE("the scene of the start is always there, wherever it lies") {
    const TemporaryFolder folder, elsewhere;
    folder.write("a/deep.vrut", kScene);
    folder.write("room.vrut", kScene);
    const fs::path outside = elsewhere.write("shown/hall.vrut", kScene),
                   twin = elsewhere.write("shown/room.vrut", kScene);
    const auto check = [](const SceneLibrary& library, const std::string& name, const fs::path& file,
                          const std::vector<std::string>& names) {
        CHECK(library.start_name() == name);
        CHECK(fs::canonical(*library.find(name)) == fs::canonical(file));
        CHECK(library.names() == names);
    };
    check(SceneLibrary({}, {}, outside), "hall.vrut", outside, {"hall.vrut"});
    CHECK_FALSE(SceneLibrary({}, {}, outside).find("shown/hall.vrut"));
    check(SceneLibrary(folder.path(), {}, outside), "hall.vrut", outside,
          {"a/deep.vrut", "hall.vrut", "room.vrut"});
    check(SceneLibrary(folder.path(), {}, folder.path() / "a/../a/deep.vrut"), "a/deep.vrut",
          folder.path() / "a/deep.vrut", {"a/deep.vrut", "room.vrut"});
    check(SceneLibrary(folder.path(), {}, twin), "shown/room.vrut", twin,
          {"a/deep.vrut", "room.vrut", "shown/room.vrut"});
    CHECK(SceneLibrary(folder.path(), {}, twin).find("room.vrut") ==
          fs::canonical(folder.path() / "room.vrut"));
    // A file without an ending, or one that is read by its content alone, is named, too.
    check(SceneLibrary(folder.path(), {}, elsewhere.write("scene", kScene)), "scene",
          elsewhere.path() / "scene", {"a/deep.vrut", "room.vrut", "scene"});
}

TEST_CASE("the names are those of scene files, sorted, and open finds each of them") {
    const TemporaryFolder folder;
    for (const std::string name : {"room.vrut", "a/b/deep.vrut", "a.vrut", "Large.VRUT", "a/room.vrut"})
        folder.write(name, kScene);
    for (const std::string name : {"notes.txt", "vrut", ".vrut", "a/room.vrut.bak", "bad\xFF.vrut"})
        folder.write(name, "");
    fs::create_directory(folder.path() / "folder.vrut");
    const SceneLibrary library(folder.path());
    CHECK(library.names() ==
          std::vector<std::string>{"Large.VRUT", "a.vrut", "a/b/deep.vrut", "a/room.vrut", "room.vrut"});
    for (const std::string& name : library.names()) CHECK(library.find(name));
    CHECK(SceneLibrary(folder.path() / "a/").names() == std::vector<std::string>{"b/deep.vrut", "room.vrut"});
}

TEST_CASE("of links those are named that stay in the folder, and no folders") {
    const TemporaryFolder outer;
    outer.write("secret.vrut", kScene);
    outer.write("scenes/room.vrut", kScene);
    const fs::path folder = outer.path() / "scenes";
    fs::create_symlink(outer.path() / "secret.vrut", folder / "link.vrut");
    fs::create_symlink(folder / "none.vrut", folder / "dangling.vrut");
    fs::create_symlink(folder / "room.vrut", folder / "inside.vrut");
    fs::create_directory_symlink(outer.path(), folder / "up");
    fs::create_directory_symlink(folder, folder / "loop");
    outer.write("scenes/notes.txt", "no scene");
    fs::create_symlink(folder / "notes.txt", folder / "notes.vrut");  // what is opened is the target
    fs::create_symlink(folder / "room.vrut", folder / "current");
    CHECK(SceneLibrary(folder).names() == std::vector<std::string>{"current", "inside.vrut", "room.vrut"});
    fs::create_directory_symlink(folder, outer.path() / "link");
    CHECK(SceneLibrary(outer.path() / "link").names() ==
          std::vector<std::string>{"current", "inside.vrut", "room.vrut"});
}

TEST_CASE("no more names come than a list may have, and a walk ends") {
    const TemporaryFolder folder;
    const SceneLibrary library(folder.path());
    const auto number = [](std::size_t i) { return std::to_string(100'000 + i); };
    for (std::size_t i = SceneLibrary::kMostNames; i-- > 0;) folder.write(number(i) + ".vrut", "");
    CHECK(library.names().size() == SceneLibrary::kMostNames);
    folder.write("1.vrut", "");
    const auto names = library.names();
    CHECK(names.size() == SceneLibrary::kMostNames);
    CHECK(names.front() == "1.vrut");
    CHECK(names.back() == number(SceneLibrary::kMostNames - 2) + ".vrut");

    const TemporaryFolder deep;  // each folder is an entry, and has one
    fs::path below = deep.path();
    for (int i = 0; i < 600; ++i) below /= "d";
    fs::create_directories(below);
    deep.write("z.vrut", "");
    CHECK(SceneLibrary(deep.path()).names() == std::vector<std::string>{"z.vrut"});

    const TemporaryFolder full;
    for (std::size_t i = 0; i < SceneLibrary::kMostEntries; ++i) full.write("f" + std::to_string(i), "");
    fs::create_directories(full.path() / "below");
    for (std::size_t i = 0; i < 5; ++i) full.write("below/" + number(i) + ".vrut", "");
    CHECK(SceneLibrary(full.path()).names().empty());  // its entries come before those below it
}

TEST_CASE("a name that is too long for the sentence is cut, and for the system refused") {
    const TemporaryFolder folder;
    const auto found = SceneLibrary(folder.path()).find(std::string(900, 'n'));
    REQUIRE_FALSE(found);
    CHECK(found.error().size() < 150);
}

TEST_CASE("notices name a scene as it was asked for, and not where its file lies") {
    const TemporaryFolder folder;
    const auto file =
        folder.write("secret/torn.vrut", "vrut-text 1\nmaterial 7 \"Torn\" image \"nowhere.png\" end\n");
    const auto scene = load_scene(file, "cars/torn.vrut");
    REQUIRE_MESSAGE(scene, scene.error());
    REQUIRE(scene->notices.size() == 1);
    CHECK(scene->notices[0].message.starts_with("cars/torn.vrut:"));
    CHECK(scene->notices[0].message.find("secret") == std::string::npos);
}

TEST_CASE("a scene is loaded with its name, its digest and what is to be said of it") {
    const TemporaryFolder folder;
    const fs::path file = folder.write("room.vrut", kScene);
    const auto scene = load_scene(file, "as it was asked for");
    REQUIRE(scene);
    CHECK(scene->name == "as it was asked for");
    CHECK(scene->sha256 == sha256_of(file));
    CHECK(scene->placed->scene->nodes().size() == 1);
    const auto wrong = load_scene(folder.write("wrong.vrut", "vrut-text 1\nnode x\n"), "wrong");
    REQUIRE_FALSE(wrong);
    CHECK(wrong.error().find("wrong.vrut:2") != std::string::npos);
    std::string names = kScene;
    for (int i = 1; i <= 1000; ++i)
        names += "node " + std::to_string(i) + " \"" + std::string(60'000, 'x') + "\" camera parent 0 end\n";
    CHECK(
        load_scene(folder.write("names.vrut", names), "names").error() ==
        (folder.path() / "names.vrut").string() +
            ": its cameras, lights, materials and backgrounds take 60042000 bytes in the state that clients "
            "get, and at most 58720256 are possible: give them shorter names");
    const fs::path pipe = folder.path() / "pipe.vrut";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    CHECK(load_scene(pipe, "pipe").error() == pipe.string() + ": it is not a regular file");
}
