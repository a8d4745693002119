#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "environment_variable.hpp"
#include "heap.hpp"
#include "scenes/import_process.hpp"
#include "scenes/library.hpp"
#include "temporary_folder.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::server::scenes;
using namespace vrut::server::net;
using namespace vrut::test;
namespace fs = std::filesystem;

/// What reads a file is this program, started anew.
int main(int argc, char** argv) {
    if (is_import_process(argc, argv)) run_import_process(argv);
    return doctest::Context(argc, argv).run();
}

namespace {

constexpr ImportLimits kAmple{std::uint64_t{4} << 30, 60s};
constexpr std::size_t kTriangles = 1'000'000;

/// A Collada scene of `nodes`, to which a triangle is known, and further libraries.
std::string collada(const std::string& nodes, const std::string& libraries = "") {
    return R"(<COLLADA version="1.4.1"><asset/><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>)" +
           libraries + R"(<library_visual_scenes><visual_scene id="s">)" + nodes +
           R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

const std::string kShape = R"(<instance_geometry url="#g"/>)";

/// Which instantiates itself: assimp 5.2 goes round until its stack ends.
std::string collada_of_itself() {
    return collada("<node id=\"n\">" + kShape + "<instance_node url=\"#n\"/></node>");
}

std::string ply_with_list_of(const std::string& count) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uint int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n" +
           count + " 0 1 2\n";
}

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
}

/// What is told of a file for which so much memory is too little; the sanitizers make an end of their own.
std::string memory_refusal([[maybe_unused]] const std::string& mebibytes) {
#ifdef VRUT_SANITIZED
    return "";
#else
    return "to read it takes more than the " + mebibytes +
           " MiB of memory that it may take; free some memory on the server's machine, or open a scene with "
           "fewer triangles or smaller textures";
#endif
}

/// A file of the system's about a process.
std::string told_of(const std::string& process, const std::string& file) {
    std::ifstream stream("/proc/" + process + "/" + file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Processes that this one has started; 0: none. Where `reads`, only one that has become the reader:
/// before that it is a copy of this program, and one stopped then holds posix_spawn() for ever.
pid_t child(bool reads = true) {
    for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        std::ifstream stream(entry.path() / "stat");
        std::string stat{std::istreambuf_iterator<char>(stream), {}};
        stat.erase(0, stat.rfind(')') + 1);
        std::istringstream fields(stat);
        std::string state;
        pid_t parent = 0;
        fields >> state >> parent;
        if (parent == getpid() && (!reads || told_of(name, "cmdline").starts_with("vrut-preview")))
            return std::stoi(name);
    }
    return 0;
}

std::size_t open_descriptors() {
    const fs::directory_iterator all("/proc/self/fd");
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

/// A server of one triangle and a folder of scenes, and two who look at it.
struct Room {
    explicit Room(const fs::path& scenes, const ImportLimits& limits)
        : server(FakeRenderer{}, with(SceneLibrary(scenes, {limits, {}}))),
          presenter(server.port()),
          watcher(server.port()) {
        was = presenter.join()["scene"];
        watcher.join("view");
        expect_frames();
    }
    static ServerOptions with(SceneLibrary library) {
        ServerOptions options;
        options.library = std::move(library);
        return options;
    }

    void open(const std::string& name) {
        presenter.send({{"type", "open"}, {"id", presenter.next_id()}, {"scene", name}});
        presenter.wait_for("ok");
    }
    /// A change reaches both as a picture.
    void expect_frames() {
        const double x = eye += 0.25;
        presenter.send({{"type", "patch"},
                        {"id", presenter.next_id()},
                        {"patch", {{"camera", {{"eye", {x, 0.5, 9}}}}}}});
        for (TestClient* client : {&presenter, &watcher}) {
            do client->send({{"type", "frame"}});
            while (client->wait_for("frame")["camera"]["eye"][0] != x);
        }
    }
    /// What both are told of the scene's loading in the end.
    Json ending() {
        Json told[2];
        for (int i = 0; i < 2; ++i) do
                told[i] = (i == 0 ? presenter : watcher).wait_for("loading", 60s);
            while (!told[i].contains("done") && !told[i].contains("refused"));
        CHECK(told[0] == told[1]);
        return told[0];
    }
    void expect_refusal(const std::string& why, const std::string& file = "heap.gltf") {
        const Json told = ending();
        REQUIRE_MESSAGE(told.contains("refused"), told.dump());
        const auto sentence = told["refused"].get<std::string>();
        CHECK_MESSAGE(sentence.find(file + ": " + why) != std::string::npos, sentence);
        CHECK(sentence.find('\n') == std::string::npos);
        expect_frames();
        CHECK(presenter.state["scene"] == was);
        CHECK(watcher.state["scene"] == was);
        CHECK(child(false) == 0);
    }

    TestServer server;
    TestClient presenter, watcher;
    Json was;
    double eye = 0;
};

}  // namespace

TEST_CASE("a foreign scene is put under two who look, and a broken one after it is refused") {
    const TemporaryFolder folder;
    write_heap(folder, 1000);
    Room room(folder.path(), kAmple);
    room.open("heap.gltf");
    CHECK(room.ending().contains("done"));
    room.expect_frames();
    for (const TestClient* client : {&room.presenter, &room.watcher}) {
        CHECK(client->state["scene"]["name"] == "heap");
        CHECK(client->state["scene"]["triangles"] == 1000);
    }
    room.was = room.presenter.state["scene"];
    fs::resize_file(folder.path() / "heap.bin", 7);
    room.open("heap.gltf");
    room.expect_refusal("");
}

TEST_CASE("a file whose reader crashes is refused, and the old scene goes on") {
    const EnvironmentVariable token("VRUT_PREVIEW_CONTROL_TOKEN", "secret");
    const TemporaryFolder folder;
    write_heap(folder, kTriangles);
    Room room(folder.path(), kAmple);
    room.open("heap.gltf");
    pid_t reader = 0;
    REQUIRE(eventually([&] { return (reader = child()) != 0; }));
    const std::string environment = told_of(std::to_string(reader), "environ");
    CHECK_MESSAGE((environment.empty() || environment.find("SAN_OPTIONS=") != std::string::npos),
                  environment);
    CHECK(environment.find("VRUT_PREVIEW_CONTROL_TOKEN") == std::string::npos);
    kill(reader, SIGABRT);
    room.expect_refusal("its reader ended with signal 6 (Aborted)");
}

TEST_CASE("a file that eats memory is refused, and the old scene goes on") {
    const TemporaryFolder folder;
    write_heap(folder, kTriangles);
    Room room(folder.path(), {16 << 20, 10s});
    room.open("heap.gltf");
    room.expect_refusal(memory_refusal("16"));
}

TEST_CASE("where memory runs out here, a sentence names the scene and says what to do") {
    const TemporaryFolder folder;
    const fs::path foreign = write_heap(folder, 1000), own = folder.write("own.vrut", "vrut-text 1\n");
    const auto run_out = [](double) { throw std::bad_alloc(); };
    for (const fs::path& path : {foreign, own}) {
        const std::string sentence =
            path.string() +
            ": there is not enough memory for it; free some memory on the server's machine, or open a scene "
            "with fewer triangles or smaller textures";
        const auto scene = import_scene(path, run_out);
        REQUIRE_FALSE(scene);
        CHECK(scene.error() == sentence);
        // By when the reading is over: while the digest is waited for.
        const auto loaded = load_scene(path, "a scene", [](double fraction) {
            if (fraction == 1) throw std::bad_alloc();
        });
        REQUIRE_FALSE(loaded);
        CHECK(loaded.error() == sentence);
    }
    CHECK(child(false) == 0);
}

TEST_CASE("files that no reader bears are refused one after the other, and the old scene goes on") {
    const TemporaryFolder folder;
    folder.write("itself.dae", collada_of_itself());
    folder.write("list.ply", ply_with_list_of("4000000000"));
    Room room(folder.path(), kAmple);
    for (const auto& [file, why] :
         {std::pair<const char*, std::string>("itself.dae", "its reader ended with "),
          {"list.ply", memory_refusal("4096")}}) {
        room.open(file);
        room.expect_refusal(why, file);
    }
}

TEST_CASE("what crashes assimp, or lets it go on for ever, ends in a sentence") {
    const std::string inner = "<instance_node url=\"#n\"/>", fbx = "; FBX 7.3.0 project file\n";
    const struct {
        const char* file;
        std::string text;
    } kFiles[] = {
        {"itself.dae", collada_of_itself()},
        {"parent.dae", collada("<node id=\"n\"><node>" + kShape + inner + "</node></node>")},
        {"each-other.dae",
         collada("<node>" + kShape + inner + "</node>",
                 "<library_nodes><node id=\"n\"><instance_node url=\"#m\"/></node><node id=\"m\">" + inner +
                     "</node></library_nodes>")},
        {"deep.dae", collada(repeated("<node>", 100'000) + kShape + repeated("</node>", 100'000))},
        {"deep.fbx", fbx + repeated("A: {\n", 100'000) + repeated("}\n", 100'000)},
        {"open.fbx", fbx + repeated("A: {\n", 100'000)},
        {"cycle.fbx", fbx +
                          "FBXHeaderExtension: {\nFBXVersion: 7300\n}\nObjects: {\n"
                          "Model: 1, \"Model::A\", \"Null\" {\n}\nModel: 2, \"Model::B\", \"Null\" {\n}\n}\n"
                          "Connections: {\nC: \"OO\",1,0\nC: \"OO\",2,1\nC: \"OO\",1,2\n}\n"},
        {"list.ply", ply_with_list_of("4000000000")},
        {"skin.dae", collada("<node><instance_controller url=\"#c\"/></node>",
                             "<library_controllers><controller id=\"c\"><skin source=\"#c\"/></controller>"
                             "</library_controllers>")},
    };
    const TemporaryFolder folder;
    for (const auto& tried : kFiles) {
        CAPTURE(tried.file);
        const fs::path path = folder.write(tried.file, tried.text);
        const auto scene = import_scene(path, {}, {ImportLimits{kAmple.bytes, 2s}, {}});
        REQUIRE_FALSE(scene);
        CHECK(scene.error().starts_with(path.string() + ": "));
        CHECK(scene.error().find('\n') == std::string::npos);
    }
    CHECK(child(false) == 0);
}

TEST_CASE("frames go on while a file is read, and one that takes for ever is refused") {
    const TemporaryFolder folder;
    write_heap(folder, kTriangles);
    Room room(folder.path(), {kAmple.bytes, 2s});
    room.open("heap.gltf");
    pid_t reader = 0;
    REQUIRE(eventually([&] { return (reader = child()) != 0; }));
    kill(reader, SIGSTOP);
    room.expect_frames();
    room.presenter.send({{"type", "open"}, {"id", room.presenter.next_id()}, {"scene", "heap.gltf"}});
    CHECK(room.presenter.wait_for("error")["code"] == "busy");
    room.expect_refusal("it is not read within 2 s");
}

TEST_CASE("a server that ends takes its reader with it, at once") {
    const TemporaryFolder folder;
    write_heap(folder, kTriangles);
    std::optional<Room> room(std::in_place, folder.path(), kAmple);
    room->open("heap.gltf");
    pid_t reader = 0;
    REQUIRE(eventually([&] { return (reader = child()) != 0; }));
    kill(reader, SIGSTOP);
    const auto start = std::chrono::steady_clock::now();
    room.reset();
    CHECK(std::chrono::steady_clock::now() - start < 4s);  // clients have 3 s to say goodbye
    CHECK(child(false) == 0);
}

TEST_CASE("the process that reads a file looks into other folders, and knows which axis is up") {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl M\nKd 1 1 1\nmap_Kd C:\\maps\\letter.png\n");
    const fs::path path =
        folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 2\nvt 0 0\nusemtl M\nf 1/1 2/1 3/1\n");
    CHECK(import_scene(path)->textures().empty());
    const auto scene =
        import_scene(path, {}, {{}, {.texture_folders = {VRUT_SCENES "/teaching/textures"}, .z_up = true}});
    REQUIRE(scene);
    CHECK(scene->notices().empty());
    CHECK(scene->textures().size() == 1);
    CHECK(scene::place(*scene).bounds.max == glm::dvec3(1, 2, 0));
}

TEST_CASE("the process that reads a file adds the studio") {
    const TemporaryFolder folder;
    const fs::path path = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 2\nf 1 2 3\n");
    for (const io::Studio studio : {io::Studio::automatic, io::Studio::on, io::Studio::off}) {
        const io::ReadOptions options{.studio = studio};
        const auto there = import_scene(path, {}, {{}, options}), here = io::read_scene(path, {}, options);
        REQUIRE_MESSAGE(there, there.error());
        REQUIRE(here);
        REQUIRE(there->textures().size() == (studio == io::Studio::off ? 0 : 7));
        CHECK(there->nodes().size() == here->nodes().size());
        for (std::size_t i = 0; i < there->textures().size(); ++i)
            CHECK(there->textures()[i].image.rgba == here->textures()[i].image.rgba);
    }
}

TEST_CASE("reading leaves neither processes nor descriptors") {
    const TemporaryFolder folder;
    const fs::path heap = write_heap(folder, 10);
    const fs::path none = folder.write("none.glb", "glTF");
    REQUIRE(import_scene(heap).has_value());
    const std::size_t before = open_descriptors();
    for (int i = 0; i < 5; ++i) {
        CHECK(import_scene(heap)->triangle_count() == 10);
        CHECK_FALSE(import_scene(none));
        CHECK_FALSE(import_scene(heap, {}, {ImportLimits{kAmple.bytes, 0s}, {}}));
        const auto stop = [](double) { throw std::runtime_error("enough"); };
        CHECK_THROWS_WITH(import_scene(heap, stop), "enough");
    }
    CHECK(open_descriptors() == before);
    CHECK(child(false) == 0);
}

TEST_CASE("what is read elsewhere is what is read here, progress and refusals too") {
    const TemporaryFolder folder;
    const fs::path heap = write_heap(folder, 100'000);
    double last = -1;
    const auto there = import_scene(heap, [&](double fraction) {
        CHECK(fraction >= last);
        CHECK(fraction <= 1);
        last = fraction;
    });
    const auto here = io::read_scene(heap);
    REQUIRE(here);
    REQUIRE(there);
    CHECK(last >= 0.5);
    CHECK(there->geometries()[0].positions == here->geometries()[0].positions);
    CHECK(there->notices() == here->notices());
    const fs::path none = folder.write("none.glb", "glTF");
    CHECK(import_scene(none).error() == io::read_scene(none).error());
}
