// A host without walls: prints the shared camera as it changes and what others point at, and reports the
// camera shown at once.
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

#include "preview_client.hpp"

using namespace vrut::client;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kOrbitSteps = 180;  // of 2°, one a frame
constexpr std::chrono::milliseconds kFrame{16};
volatile std::sig_atomic_t interrupted = 0;

constexpr const char* kUsage =
    "Usage: example_host [--host ADDRESS] [--port N] [--path PATH] [--tls] [--ca-file FILE]\n"
    "                    [--server-name NAME] [--token TEXT] [--name TEXT] [--lead]\n\n"
    "Follows the camera of VRUT Preview and what others point at: one line a change, until interrupted.\n\n"
    "  --host         default 127.0.0.1\n"
    "  --port         default 8080\n"
    "  --path         of the WebSocket, default /ws; that of a room at an edge is /rooms/NAME/ws\n"
    "  --tls          speak TLS\n"
    "  --ca-file      of authorities that are trusted (PEM), default: the system's; implies --tls\n"
    "  --server-name  that the certificate must have, default: the host; implies --tls\n"
    "  --token        default: VRUT_PREVIEW_TOKEN\n"
    "  --name         that others see, default example_host\n"
    "  --lead         also leads the camera once around its center\n";

struct Arguments {
    Options options;
    bool lead = false, help = false;
};

std::uint16_t read_port(const std::string& text) {
    const int port = std::atoi(text.c_str());
    if (port < 1 || port > 65'535) throw std::invalid_argument("--port " + text);
    return static_cast<std::uint16_t>(port);
}

/// Throws std::invalid_argument where they cannot be understood.
Arguments read_arguments(int argc, char** argv) {
    Arguments arguments;
    arguments.options.name = "example_host";
    if (const char* token = std::getenv("VRUT_PREVIEW_TOKEN")) arguments.options.token = token;
    const auto tls = [&]() -> Tls& {
        if (!arguments.options.tls) arguments.options.tls.emplace();
        return *arguments.options.tls;
    };
    for (int i = 1; i < argc; ++i) {
        const std::string option = argv[i];
        const auto value = [&] {
            if (i + 1 == argc) throw std::invalid_argument(option);
            return std::string(argv[++i]);
        };
        if (option == "--host")
            arguments.options.host = value();
        else if (option == "--port")
            arguments.options.port = read_port(value());
        else if (option == "--path")
            arguments.options.path = value();
        else if (option == "--tls")
            tls();
        else if (option == "--ca-file")
            tls().ca_file = value();
        else if (option == "--server-name")
            tls().server_name = value();
        else if (option == "--token")
            arguments.options.token = value();
        else if (option == "--name")
            arguments.options.name = value();
        else if (option == "--lead")
            arguments.lead = true;
        else if (option == "--help")
            arguments.help = true;
        else
            throw std::invalid_argument(option);
    }
    return arguments;
}

void print_vector(const char* name, const Vector3& v) {
    std::printf(" %s %.17g %.17g %.17g", name, v[0], v[1], v[2]);
}

void print_camera(std::int64_t revision, const Camera& camera) {
    std::printf("revision %lld", static_cast<long long>(revision));
    print_vector("eye", camera.eye);
    print_vector("focus", camera.focus);
    print_vector("up", camera.up);
    std::printf(" fov %.17g\n", camera.fov);
    std::fflush(stdout);
}

void print_pointed(const Pointed& pointed) {
    std::printf("%s", pointed.point ? "points" : "points no more");
    if (pointed.point) {
        print_vector("at", *pointed.point);
        print_vector("normal", pointed.normal);
    }
    std::printf(" client %s name %s\n", pointed.client.c_str(), pointed.name.c_str());
    std::fflush(stdout);
}

/// `v` turned about the vertical through `center`.
Vector3 turned(const Vector3& v, const Vector3& center, double radians) {
    const double x = v[0] - center[0], z = v[2] - center[2], c = std::cos(radians), s = std::sin(radians);
    return {center[0] + c * x + s * z, v[1], center[2] - s * x + c * z};
}

/// The camera after `step` steps around its center; the last is where it began.
Camera on_orbit(const Camera& start, int step) {
    const double radians = 2 * kPi * (step % kOrbitSteps) / kOrbitSteps;
    Camera camera = start;
    camera.eye = turned(start.eye, start.center, radians);
    camera.focus = turned(start.focus, start.center, radians);
    camera.up = turned(start.up, {0, 0, 0}, radians);
    return camera;
}

void run(const Arguments& arguments) {
    PreviewClient preview(arguments.options);
    preview.on_connection = [&](bool connected) {
        std::fprintf(stderr, connected ? "connected as %s\n" : "disconnected\n", preview.client().c_str());
    };
    int step = 0;
    preview.on_error = [&](const Problem& problem) {
        if (problem.id) step = kOrbitSteps;  // somebody else leads
        std::fprintf(stderr, "%s: %s\n", problem.code.c_str(), problem.message.c_str());
    };
    preview.on_camera = [&](const Camera& camera, bool /*mine*/) {
        print_camera(preview.revision(), camera);
        preview.report_shown(preview.revision());  // a real host: when its walls show it
    };

    preview.on_pointed = print_pointed;  // a real host draws a dot on its walls

    Camera start;
    while (!interrupted) {
        preview.poll(std::chrono::milliseconds(0));
        std::this_thread::sleep_for(kFrame);  // a real host draws its walls here
        if (!arguments.lead || !preview.connected() || step == kOrbitSteps) continue;
        if (step == 0) start = preview.camera();
        if (preview.lead(on_orbit(start, step + 1)) != 0) ++step;
    }
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    try {
        arguments = read_arguments(argc, argv);
    } catch (const std::invalid_argument& error) {
        std::fprintf(stderr, "example_host: cannot understand %s; --help tells the options\n", error.what());
        return 2;
    }
    if (arguments.help) {
        std::fputs(kUsage, stdout);
        return 0;
    }
    const auto stop = [](int) { interrupted = 1; };
    std::signal(SIGINT, stop);
    std::signal(SIGTERM, stop);
    run(arguments);
    return 0;
}
