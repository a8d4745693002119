#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "base/detached_thread.hpp"
#include "commands/commands.hpp"
#include "io/write_scene.hpp"
#include "observe/log.hpp"
#include "scenes/import_process.hpp"

namespace {

using namespace vrut::server;

constexpr int kFailed = 1, kWrongUsage = 2;

/// Where one is closed, what is opened next would get its number, and what is printed.
void open_standard_descriptors() {
    int opened = 0;
    do {
        opened = ::open("/dev/null", O_RDWR);
    } while (opened >= 0 && opened <= STDERR_FILENO);
    ::close(opened);
}

/// Numbers between separators, all of them, or CLI::ValidationError.
template <class Number, std::size_t N>
std::array<Number, N> parse_numbers(const std::string& option, const std::string& text, char separator,
                                    const char* expected) {
    std::array<Number, N> numbers{};
    const char* next = text.data();
    const char* const last = text.data() + text.size();
    for (std::size_t i = 0; i < N; ++i) {
        const auto [end, error] = std::from_chars(next, last, numbers[i]);
        const bool ends_right = i + 1 == N ? end == last : end != last && *end == separator;
        if (error != std::errc() || !ends_right)
            throw CLI::ValidationError(option,
                                       "expected " + std::string(expected) + ", found '" + text + "'");
        next = end + 1;
    }
    return numbers;
}

void add_vector(CLI::App& command, const std::string& name, std::optional<glm::dvec3>& target,
                const char* help) {
    command.add_option_function<std::string>(
        name,
        [name, &target](const std::string& text) {
            const auto numbers = parse_numbers<double, 3>(name, text, ',', "x,y,z");
            target = glm::dvec3(numbers[0], numbers[1], numbers[2]);
        },
        help);
}

void add_device(CLI::App& command, std::optional<int>& device) {
    command.add_option("--device", device, "EGL device to draw on (default: the first that works)")
        ->check(CLI::NonNegativeNumber);
}

void add_size(CLI::App& command, int& width, int& height) {
    command.add_option_function<std::string>(
        "--size",
        [&width, &height](const std::string& text) {
            const auto size = parse_numbers<int, 2>("--size", text, 'x', "WIDTHxHEIGHT");
            if (size[0] < 1 || size[1] < 1)
                throw CLI::ValidationError("--size", "a picture has a pixel at least");
            width = size[0];
            height = size[1];
        },
        "Pixels (default: 1280x720)");
}

void add_serve(CLI::App& app, commands::ServeArguments& arguments) {
    CLI::App* command = app.add_subcommand("serve", "Serve a scene to tablets, hosts and scripts");
    command->add_option("scene", arguments.scene, "Scene file (default: the car)");
    command->add_option("--listen", arguments.listen, "Address and port; port 0 picks one")
        ->capture_default_str();
    command->add_option("--allow-origin", arguments.allowed_origins,
                        "Origin whose pages may connect, besides the server's own");
    command->add_option("--max-clients", arguments.max_clients, "Clients at one time")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    command->add_option("--token-file", arguments.token_file, R"(JSON file {"control": …, "view": …})");
    command->add_option("--scenes", arguments.scenes, "Folder of scenes that clients may open");
    command->add_option("--record", arguments.record, "Folder for recorded sessions");
    add_device(*command, arguments.device);
    auto* level = command->add_option_function<std::string>(
        "--log-level", [](const std::string& text) { spdlog::set_level(spdlog::level::from_str(text)); },
        "debug, info, warning, error or off (default: info)");
    level->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}));
    command->callback([&arguments] { commands::serve_command(arguments); });
}

/// Options that stand for patches of the state.
void add_patches(CLI::App& command, commands::RenderArguments& arguments) {
    const auto add = [&](const std::string& name, const std::string& text) {
        arguments.patches.emplace_back(name, text);
    };
    command
        .add_option_function<std::string>(
            "--mode",
            [add](const std::string& mode) { add("--mode", R"({"renderer":{"mode":")" + mode + "\"}}"); },
            "realistic or stylized")
        ->check(CLI::IsMember({"realistic", "stylized"}));
    command.add_flag_callback(
        "--wireframe", [add] { add("--wireframe", R"({"renderer":{"wireframe":true}})"); }, "Edges only");
    command.add_option_function<std::int64_t>(
        "--select",
        [add](std::int64_t node) {
            add("--select", R"({"selection":{"node":)" + std::to_string(node) + "}}");
        },
        "Node to mark");
    const auto is_id = [](const std::string& other) {
        return [other](const std::string& text) {
            const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
            return digits || text == other ? std::string() : "expected a node's id or " + other;
        };
    };
    command
        .add_option_function<std::string>(
            "--light",
            [add](const std::string& light) { add("--light", R"({"lights":{"active":")" + light + "\"}}"); },
            "Id of the light node that shines, or headlight")
        ->check(is_id("headlight"));
    command
        .add_option_function<std::string>(
            "--background",
            [add](const std::string& background) {
                add("--background",
                    R"({"backgrounds":{"active":")" + (background == "none" ? "color" : background) + "\"}}");
            },
            "Id of a background node, or none for the plain colour")
        ->check(is_id("none"));
}

void add_render(CLI::App& app, commands::RenderArguments& arguments) {
    CLI::App* command = app.add_subcommand("render", "Draw one picture of a scene");
    command->add_option("scene", arguments.scene, "Scene file")->required();
    command->add_option("-o,--output", arguments.output, "Picture, ending in .png or .jpg")->required();
    add_size(*command, arguments.width, arguments.height);
    command->add_option("--samples", arguments.samples, "Samples a pixel; 1: its centre")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    auto* detail =
        command
            ->add_option("--detail", arguments.detail,
                         "How far, in pixels, drawn surfaces may lie from the scene's; 0: every triangle")
            ->check(CLI::Range(0.0, 1000.0))
            ->capture_default_str();
    command->add_option("--camera", arguments.camera_file, "JSON file with the state document's camera");
    add_vector(*command, "--eye", arguments.eye, "Where the eye is: x,y,z");
    add_vector(*command, "--focus", arguments.focus, "What it looks at: x,y,z");
    add_vector(*command, "--up", arguments.up, "What is up: x,y,z");
    command->add_option("--fov", arguments.fov, "Vertical field of view in degrees")
        ->check(CLI::Range(1.0, 170.0));
    command->add_option("--set", arguments.set, "JSON merge patch on the state document");
    add_patches(*command, arguments);
    command->add_option("--jpeg-quality", arguments.jpeg_quality, "1 to 100")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    auto* reference = command
                          ->add_flag("--reference", arguments.reference,
                                     "By the reference renderer, in double precision and without a GPU")
                          ->excludes(detail);
    command->add_option("--float", arguments.unrounded, "Its unrounded values too, as a PFM picture")
        ->needs(reference);
    command->add_option("--ids", arguments.ids, "The node ids at the pixels' centres too, as a PNG picture");
    command->add_flag("--stats", arguments.stats, "Print what the picture took, as JSON")
        ->excludes(reference);
    add_device(*command, arguments.device);
    command->callback([&arguments] { commands::render_command(arguments); });
}

void add_replay(CLI::App& app, commands::ReplayArguments& arguments) {
    CLI::App* command =
        app.add_subcommand("replay", "Play a recorded session again; prints its final camera");
    command->add_option("log", arguments.log, "Recorded session (.jsonl)")->required();
    command->add_option("--scene", arguments.scene, "Scene file (default: the one that was recorded)");
    command->add_option("--out", arguments.frames, "Folder to write the session's frames to");
    add_device(*command, arguments.device);
    command->callback([&arguments] { commands::replay_command(arguments); });
}

void add_info(CLI::App& app, commands::InfoArguments& arguments) {
    CLI::App* command = app.add_subcommand("info", "Tell what a scene holds");
    command->add_option("scene", arguments.scene, "Scene file")->required();
    command->add_flag("--json", arguments.json, "As JSON");
    command->callback([&arguments] { commands::info_command(arguments); });
}

void add_convert(CLI::App& app, commands::ConvertArguments& arguments) {
    CLI::App* command = app.add_subcommand("convert", "Write a scene in another format");
    command->add_option("in", arguments.in, "Scene file, of any format that is read")->required();
    command->add_option("out", arguments.out, "File to write, ending in " + vrut::io::written_extensions())
        ->required();
    command->callback([&arguments] { commands::convert_command(arguments); });
}

void add_compare(CLI::App& app, commands::CompareArguments& arguments) {
    CLI::App* command = app.add_subcommand("compare", "Tell how far two pictures are apart");
    command->add_option("a", arguments.a, "Picture (PNG or JPEG)")->required();
    command->add_option("b", arguments.b, "Another of the same size")->required();
    command->add_flag("--json", arguments.json, "As JSON");
    command->add_option("--map", arguments.map,
                        "PNG to write FLIP's error at each pixel to: black 0, white 1");
    command->callback([&arguments] { commands::compare_command(arguments); });
}

void add_chart(CLI::App& app, commands::ChartArguments& arguments) {
    CLI::App* command = app.add_subcommand("chart", "Measure speed against accuracy, and draw charts of it");
    command->add_option("scenes", arguments.scenes, "Scene files (default: the car)");
    auto* out = command->add_option("--out", arguments.out,
                                    "Folder for CSV, SVG and a page; what is in it is not measured again");
    auto* calibrate = command->add_flag(
        "--calibrate", arguments.calibrate,
        "Measure the levels that a server of the scene draws with, on this machine, and store them");
    out->excludes(calibrate);
    add_size(*command, arguments.width, arguments.height);
    command->add_option("--frames", arguments.frames, "Frames of each setting, on one orbit")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--triangles", arguments.most_triangles, "Of the largest scene made for the charts")
        ->capture_default_str();
    add_device(*command, arguments.device);
    command->callback([&arguments] {
        if (!arguments.calibrate && arguments.out.empty()) throw CLI::RequiredError("--out");
        if (arguments.calibrate && arguments.scenes.size() > 1)
            throw CLI::ValidationError("--calibrate", "one scene at a time");
        commands::chart_command(arguments);
    });
}

/// The exit status. What goes wrong is printed.
int run(int argc, char** argv) try {
    if (scenes::is_import_process(argc, argv)) scenes::run_import_process(argv);
    open_standard_descriptors();
    observe::start_log();  // results go to standard output, what is told on the way to standard error

    CLI::App app("Remote preview of a car for a CAVE: serves a scene to tablets, draws pictures of it",
                 "vrut-preview");
    app.set_version_flag("--version", "vrut-preview " VRUT_VERSION);
    app.require_subcommand(1);
    commands::ServeArguments serve;
    commands::RenderArguments render;
    commands::ReplayArguments replay;
    commands::InfoArguments info;
    commands::ConvertArguments convert;
    commands::CompareArguments compare;
    commands::ChartArguments chart;
    add_serve(app, serve);
    add_render(app, render);
    add_replay(app, replay);
    add_info(app, info);
    add_convert(app, convert);
    add_compare(app, compare);
    add_chart(app, chart);
    try {
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
        // CLI11 tells of a missing command only, and not of the word that is none.
        const bool unknown = app.get_subcommands().empty() && !app.remaining().empty();
        std::cerr << "vrut-preview: "
                  << (unknown ? "there is no command '" + app.remaining().front() + "'" : error.what())
                  << "; --help tells more\n";
        return kWrongUsage;
    }
} catch (const std::invalid_argument& error) {
    std::cerr << "vrut-preview: " << error.what() << "\n";
    return kWrongUsage;
} catch (const std::exception& error) {
    std::cerr << "vrut-preview: " << error.what() << "\n";
    return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
    const int status = run(argc, argv);
    if (base::detached_threads() == 0) return status;
    std::cout.flush();
    std::fflush(nullptr);
    std::_Exit(status);
}
