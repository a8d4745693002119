// How the program ends: when it is told to, whatever it is doing, and when it is killed.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/ptrace.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>

#include "environment_variable.hpp"
#include "heap.hpp"
#include "pem_files.hpp"
#include "program.hpp"
#include "raw_connection.hpp"
#include "temporary_folder.hpp"
#include "test_client.hpp"

using namespace vrut::test;
namespace fs = std::filesystem;

namespace {

const std::string kScene = VRUT_SCENES "/teaching/triangle.vrut";

std::vector<std::string> serve(const std::vector<std::string>& options, const std::string& scene = kScene) {
    std::vector<std::string> words{"serve", scene, "--listen", "127.0.0.1:0", "--log-level", "error"};
    words.insert(words.end(), options.begin(), options.end());
    return words;
}

/// A grid in the project's own text: tens of megabytes.
void write_grid(const fs::path& path, int side) {
    std::ofstream out(path);
    out << "vrut-text 1\ngeometry 1 vertices " << side * side;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) out << '\n' << x << ' ' << y << ' ' << (x * y) % 17;
    out << "\ntriangles " << 2 * (side - 1) * (side - 1);
    for (int y = 0; y + 1 < side; ++y)
        for (int x = 0; x + 1 < side; ++x) {
            const int a = y * side + x, b = a + side;
            out << '\n' << a << ' ' << a + 1 << ' ' << b << ' ' << a + 1 << ' ' << b + 1 << ' ' << b;
        }
    out << "\nend\nnode 1 \"Grid\" geometry geometry 1 end\n";
}

/// Where there is a client who says goodbye, without the time that is left to those who do not.
void expect_end(Program& program, int signal = SIGTERM, TestClient* polite = nullptr) {
    const auto start = std::chrono::steady_clock::now();
    program.signal(signal);
    if (polite) CHECK(polite->wait_for_close() == 1001);
    const auto status = program.wait(20s);
    const auto took = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    REQUIRE(status.has_value());
    CHECK_MESSAGE((WIFEXITED(*status) && WEXITSTATUS(*status) == 0),
                  "wait status " << *status << ": " << program.output());
    MESSAGE("ended after " << took << " s");
    CHECK(took < 3);  // what Server promises
}

/// The process that reads a scene for `program`, once it is one.
pid_t reader_of(const Program& program) {
    pid_t reader = 0;
    const auto reads = [&] {
        for (const pid_t child : children_of(program.process())) {
            std::ifstream stream("/proc/" + std::to_string(child) + "/cmdline");
            const std::string words{std::istreambuf_iterator<char>(stream), {}};
            if (words.find("import") != std::string::npos) reader = child;
        }
        return reader != 0;
    };
    REQUIRE(eventually(reads, 10s));
    return reader;
}

bool is_gone(pid_t process) {
    std::ifstream stream("/proc/" + std::to_string(process) + "/stat");
    std::string stat{std::istreambuf_iterator<char>(stream), {}};
    return stat.empty() || stat.find(") Z") != std::string::npos;
}

/// A program that a client has asked to open a scene of `folder`.
struct Opening {
    Opening(const TemporaryFolder& folder, const std::string& scene)
        : program(serve({"--scenes", folder.path().string()})), client(program.port()) {
        client.join();
        client.send({{"type", "open"}, {"id", 1}, {"scene", scene}});
        client.wait_for("ok");
    }

    Program program;
    TestClient client;
};

/// A program that records on a disk that has begun to hang, with the client that asked for it.
struct HangingRecording {
    HangingRecording() {
        client.join();
        client.send({{"type", "record"}, {"id", client.next_id()}, {"action", "start"}, {"name", "hung"}});
        client.wait_for("ok");
        folder.write("hangs", "");
        move();
    }
    /// The revision that the state has then.
    Json move() {
        client.send({{"type", "navigate"}, {"id", client.next_id()}, {"rotate", {5, 0}}});
        return client.wait_for("ok")["revision"];
    }

    TemporaryFolder folder;
    EnvironmentVariable preload{"LD_PRELOAD", VRUT_HANGING_DISK},
        marker{"VRUT_TEST_DISK_HANGS", (folder.path() / "hangs").c_str()};
    Program program{serve({"--record", folder.path().string()}, VRUT_CARS "/car-20k.vrut")};
    TestClient client{program.port()};
};

/// Writes grid.gltf: one part of that many triangles, of two to a square.
void write_grid(const TemporaryFolder& folder, std::uint32_t side) {
    std::vector<float> points;
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x)
            points.insert(points.end(), {static_cast<float>(x), static_cast<float>(y),
                                         static_cast<float>((x * 7919 + y * 104729) % 13) / 13});
    std::vector<std::uint32_t> corners;
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
            corners.insert(corners.end(), {a, a + 1, b, a + 1, b + 1, b});
        }
    const std::size_t first = points.size() * sizeof(float), second = corners.size() * sizeof(std::uint32_t);
    std::ofstream out(folder.path() / "grid.bin", std::ios::binary);
    out.write(reinterpret_cast<const char*>(points.data()), static_cast<std::streamsize>(first));
    out.write(reinterpret_cast<const char*>(corners.data()), static_cast<std::streamsize>(second));
    const Json gltf{
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"name", "Grid"}, {"mesh", 0}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", points.size() / 3}},
          {{"bufferView", 1}, {"componentType", 5125}, {"type", "SCALAR"}, {"count", corners.size()}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteLength", first}},
          {{"buffer", 0}, {"byteOffset", first}, {"byteLength", second}}}},
        {"buffers", {{{"uri", "grid.bin"}, {"byteLength", first + second}}}}};
    folder.write("grid.gltf", gltf.dump());
}

}  // namespace

TEST_CASE("SIGTERM while the levels of one part of ten million triangles are made") {
    const TemporaryFolder folder;
    write_grid(folder, 2240);
    Program program(serve({}, (folder.path() / "grid.gltf").string()));
    TestClient client(program.port());
    client.join();
    client.grant();
    client.wait_for("frame", 60s);  // the levels are begun behind it
    std::this_thread::sleep_for(500ms);
    expect_end(program, SIGTERM, &client);
}

TEST_CASE("SIGTERM while the digest of a scene of five gigabytes, which is read, is computed") {
    const TemporaryFolder folder;
    fs::copy_file(VRUT_TEST_GLB, folder.path() / "long.glb");
    fs::resize_file(folder.path() / "long.glb", std::uintmax_t{5} << 30);
    Opening opening(folder, "long.glb");
    Json loading = Json::object();
    while (loading.value("fraction", 0.0) != 1) loading = opening.client.wait_for("loading", 20s);
    CHECK_FALSE(loading.contains("done"));  // the scene is read, and its digest is not there yet
    expect_end(opening.program, SIGTERM, &opening.client);
}

TEST_CASE("SIGTERM while a recording's disk hangs, a large file is encoded, and a client is silent") {
    HangingRecording hanging;
    TestClient silent(hanging.program.port(), {.receive_buffer = 4096});
    silent.join("view");
    for (int i = 0; i < 8; ++i) silent.send({{"type", "frame"}});
    silent.send({{"type", "snapshot"}, {"id", 1}, {"width", 4000}, {"height", 2000}, {"format", "png"}});
    hanging.client.wait_for_still();
    expect_end(hanging.program);
}

TEST_CASE("a disk that hangs ends the recording, with a notice, and nothing else") {
    HangingRecording hanging;
    TestClient& client = hanging.client;
    const auto is_served = [&] {
        const Json revision = hanging.move();
        CHECK(client.wait_for_still()["revision"] >= revision);
        client.send({{"type", "tree"}, {"id", client.next_id()}});
        client.wait_for("tree");
        CHECK(http(hanging.program.port(), "GET", "/readyz").status == 200);
    };
    is_served();
    client.wait_for_notice("The recording 'hung' has ended: ");
    CHECK_FALSE(client.state.contains("recording"));
    is_served();
    expect_end(hanging.program, SIGTERM, &client);
}

TEST_CASE("SIGTERM, SIGINT and SIGHUP while frames go to clients that do not take them") {
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        Program program(serve({}, VRUT_CARS "/car-20k.vrut"));
        TestClient presenter(program.port());
        presenter.join();
        std::vector<std::unique_ptr<TestClient>> slow;
        for (int i = 0; i < 8; ++i) {
            slow.push_back(
                std::make_unique<TestClient>(program.port(), ConnectOptions{.receive_buffer = 4096}));
            slow.back()->join("view");
        }
        for (int i = 1; i <= 8; ++i) {
            for (const auto& client : slow) client->send({{"type", "frame"}});
            presenter.send({{"type", "frame"}});
            presenter.send({{"type", "navigate"}, {"rotate", {7, 0}}});
            presenter.wait_for("frame");
        }
        expect_end(program, signal, &presenter);
    }
}

TEST_CASE("SIGHUP makes a server read the files of its certificate again, and does not end it") {
    const TemporaryFolder folder;
    const vrut::server::net::CertificateAuthority authority(folder.path() / "authority.pem");
    const fs::path certificate = folder.path() / "certificate.pem", key = folder.path() / "key.pem";
    const auto first = authority.issue({}), second = authority.issue({});
    write_pem(first, certificate, key);
    auto words = serve({"--tls-cert", certificate.string(), "--tls-key", key.string()});
    std::ranges::replace(words, "error", "warning");
    Program program(words);
    const std::uint16_t port = program.port();
    const auto shows = [port](const vrut::server::net::Certificate& issued) {
        RawConnection connection(port, Over::tls);
        return X509_cmp(SSL_get0_peer_certificate(connection.tls()), issued.x509.get()) == 0;
    };
    RawConnection open(port, Over::tls);
    CHECK(shows(first));
    write_pem(second, certificate, key);
    CHECK(shows(first));
    program.signal(SIGHUP);
    CHECK(eventually([&] { return shows(second); }));
    open.send("GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    CHECK(open.answer().body == "ok\n");
    fs::remove(key);
    program.signal(SIGHUP);
    CHECK(shows(second));
    expect_end(program, SIGTERM);
    CHECK(program.output().find("--tls-key") != std::string::npos);
}

TEST_CASE("SIGTERM while a large scene is loaded, at any moment of it") {
    const TemporaryFolder folder;
    write_grid(folder.path() / "grid.vrut", 700);
    for (const auto after : {0ms, 100ms, 300ms}) {
        Opening opening(folder, "grid.vrut");
        std::this_thread::sleep_for(after);
        expect_end(opening.program, SIGTERM, &opening.client);
    }
}

TEST_CASE("SIGTERM while another format's file is read, and while its reader hangs") {
    const TemporaryFolder folder;
    write_heap(folder, 2'000'000);
    for (const bool hangs : {false, true}) {
        Opening opening(folder, "heap.gltf");
        const pid_t reader = reader_of(opening.program);
        if (hangs) kill(reader, SIGSTOP);
        expect_end(opening.program, SIGTERM, &opening.client);
        CHECK(is_gone(reader));
    }
}

TEST_CASE("SIGTERM while a scene of ten million triangles is read, at any moment of it") {
    const TemporaryFolder folder;
    write_heap(folder, 10'000'000);
    for (const auto after : {0ms, 500ms, 1000ms, 1500ms, 2000ms, 2500ms}) {
        Opening opening(folder, "heap.gltf");
        std::this_thread::sleep_for(after);
        expect_end(opening.program, SIGTERM, &opening.client);
    }
}

TEST_CASE("SIGTERM while the digest of forty gigabytes is computed") {
    const TemporaryFolder folder;
    fs::resize_file(folder.write("zeros.vrut", ""), std::uintmax_t{40} << 30);
    Opening opening(folder, "zeros.vrut");
    expect_end(opening.program, SIGTERM, &opening.client);
}

TEST_CASE("SIGTERM while a file does not open, as on a disk that hangs") {
    std::signal(SIGIO, SIG_IGN);  // tells that somebody waits for the lease below
    const TemporaryFolder folder;
    const fs::path scene = folder.path() / "triangle.vrut";
    fs::copy_file(kScene, scene);
    const int leased = ::open(scene.c_str(), O_RDWR | O_CLOEXEC);
    REQUIRE(fcntl(leased, F_SETLEASE, F_WRLCK) == 0);  // whoever opens it now waits: 45 s, by Linux's default
    Opening opening(folder, "triangle.vrut");
    expect_end(opening.program, SIGTERM, &opening.client);
    close(leased);
}

TEST_CASE("SIGTERM while a reader does not end, as on a disk that hangs") {
    const TemporaryFolder folder;
    write_heap(folder, 2'000'000);
    Opening opening(folder, "heap.gltf");
    const pid_t reader = reader_of(opening.program);
    REQUIRE(ptrace(PTRACE_SEIZE, reader, nullptr, nullptr) == 0);  // only this process sees it end
    expect_end(opening.program, SIGTERM, &opening.client);
    CHECK(waitpid(reader, nullptr, __WALL) == reader);
}

TEST_CASE("a reader ends with a program that is killed, also while the first scene is read") {
    const TemporaryFolder folder;
    write_heap(folder, 2'000'000);
    for (const int signal : {SIGKILL, SIGTERM}) {
        Program program(serve({}, (folder.path() / "heap.gltf").string()));
        const pid_t reader = reader_of(program);
        program.signal(signal);
        CHECK(program.wait(5s).has_value());
        CHECK(eventually([&] { return is_gone(reader); }, 5s));
    }
}

TEST_CASE("whoever sends SIGTERM again and again gets the same end") {
    for (const auto pause : {1ms, 100ms}) {
        Program program(serve({}));
        TestClient client(program.port(), {.receive_buffer = 4096});  // does not say goodbye
        client.join();
        std::optional<int> status;
        for (int i = 0; i < 5000 && !status; ++i) {
            program.signal(SIGTERM);
            status = program.wait(pause);
        }
        REQUIRE(status.has_value());
        CHECK_MESSAGE(*status == 0, "wait status " << *status);
    }
}

TEST_CASE("a program that is killed while it records leaves a log that replays") {
    const TemporaryFolder folder;
    std::string longest;
    for (const auto after : {0ms, 30ms, 200ms, 700ms}) {
        const std::string name = "killed-" + std::to_string(after.count()), file = name + ".jsonl";
        Program program(serve({"--record", folder.path().string()}));
        TestClient client(program.port());
        client.join();
        client.send({{"type", "record"}, {"id", 1}, {"action", "start"}, {"name", name}});
        client.wait_for("ok");
        client.send(pointer_event("pointerdown", 10, 10));
        const auto end = std::chrono::steady_clock::now() + after;
        for (int i = 0; std::chrono::steady_clock::now() < end; ++i)
            client.send(pointer_event("pointermove", 10 + i % 900, 10 + i % 600));
        program.signal(SIGKILL);
        REQUIRE(program.wait(5s).has_value());

        Program replay({"replay", (folder.path() / file).string(), "--scene", kScene});
        const auto status = replay.wait(60s);
        const std::string output = replay.output();
        REQUIRE(status.has_value());
        CHECK_MESSAGE(*status == 0, output);
        CHECK(output.find("\"eye\"") != std::string::npos);
        longest = std::max(longest, folder.read(file), [](auto& a, auto& b) { return a.size() < b.size(); });
    }
    CHECK(longest.size() > 10'000);
    folder.write("cut.jsonl", longest.substr(0, longest.rfind("pointermove")));
    Program replay({"replay", (folder.path() / "cut.jsonl").string(), "--scene", kScene});
    CHECK(replay.wait(60s) == 0);
    CHECK(replay.output().find("the log is cut off here") != std::string::npos);
}

TEST_CASE("a log that nobody reads holds nothing up, neither the work nor the end") {
    Program program({"serve", kScene, "--listen", "127.0.0.1:0", "--log-level", "debug"});
    TestClient client(program.port());  // from here on nobody reads
    client.join();
    constexpr int kRefused = 3000;  // each is a line: more than a pipe takes
    for (int i = 0; i < kRefused; ++i) client.send({{"type", "patch"}, {"patch", {{"nothing", i}}}});
    client.send({{"type", "tree"}, {"id", 1}});
    CHECK(client.wait_for("tree", 10s)["id"] == 1);
    expect_end(program, SIGTERM, &client);
    const std::string said = program.output();
    CHECK(said.find("event=message_refused") != std::string::npos);
    CHECK(said.size() < 100'000);
}
