#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "../unit/environment_variable.hpp"
#include "../unit/temporary_folder.hpp"
#include "import_process.hpp"
#include "test_client.hpp"

using namespace vrut;
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

/// Triangles without extent: 12 bytes a vertex, which take a while to be read.
fs::path write_heap(const TemporaryFolder& folder, std::size_t triangles) {
    const std::string count = std::to_string(3 * triangles), size = std::to_string(36 * triangles);
    fs::resize_file(folder.write("heap.bin", ""), 36 * triangles);
    return folder.write("heap.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"name": "Heap", "mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
                                         count + R"(}], "bufferViews": [{"buffer": 0, "byteLength": )" +
                                         size + R"(}], "buffers": [{"uri": "heap.bin", "byteLength": )" +
                                         size + "}]}");
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
        : server(FakePainter{}, with(SceneLibrary(scenes, limits))),
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
    void expect_refusal(const std::string& why) {
        const Json told = ending();
        REQUIRE_MESSAGE(told.contains("refused"), told.dump());
        const auto sentence = told["refused"].get<std::string>();
        CHECK_MESSAGE(sentence.find("heap.gltf: " + why) != std::string::npos, sentence);
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
    CHECK(environment.find("PATH=") != std::string::npos);
    CHECK(environment.find("VRUT_PREVIEW_CONTROL_TOKEN") == std::string::npos);
    kill(reader, SIGABRT);
    room.expect_refusal("its reader ended with signal 6 (Aborted)");
}

TEST_CASE("a file that eats memory is refused, and the old scene goes on") {
    const TemporaryFolder folder;
    write_heap(folder, kTriangles);
    Room room(folder.path(), {16 << 20, 10s});
    room.open("heap.gltf");
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    room.expect_refusal("");  // of which the sanitizer makes an end of its own
#else
    room.expect_refusal("to read it takes more than the 16 MiB of memory that it may take");
#endif
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

TEST_CASE("reading leaves neither processes nor descriptors") {
    const TemporaryFolder folder;
    const fs::path heap = write_heap(folder, 10);
    const fs::path none = folder.write("none.glb", "glTF");
    REQUIRE(import_scene(heap).has_value());
    const std::size_t before = open_descriptors();
    for (int i = 0; i < 5; ++i) {
        CHECK(import_scene(heap)->triangle_count() == 10);
        CHECK_FALSE(import_scene(none));
        CHECK_FALSE(import_scene(heap, {}, ImportLimits{kAmple.bytes, 0s}));
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
    const auto here = read_scene(heap);
    REQUIRE(here);
    REQUIRE(there);
    CHECK(last >= 0.5);
    CHECK(there->geometries()[0].positions == here->geometries()[0].positions);
    CHECK(there->notices() == here->notices());
    const fs::path none = folder.write("none.glb", "glTF");
    CHECK(import_scene(none).error() == read_scene(none).error());
}
