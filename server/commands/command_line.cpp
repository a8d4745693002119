#include "command_line.hpp"

#include <spdlog/spdlog.h>

#include <array>
#include <charconv>
#include <sstream>

#include "io/read_scene.hpp"
#include "io/write_scene.hpp"
#include "room_relay.hpp"

namespace vrut::server::commands {

namespace {

// The groups of options, as help shows them.
constexpr const char *kNetwork = "Network", *kAccess = "Access", *kScene = "Scene", *kDrawing = "Drawing",
                     *kOutput = "Output", *kCamera = "Camera", *kMeasurement = "Measurement",
                     *kGeneral = "General";

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

template <class Number>
std::string text_of(Number number) {
    std::ostringstream stream;
    stream << number;
    return stream.str();
}

bool has_digits_only(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// A validator, as CLI11 has it: empty, or what is wrong.
std::string is_whole_number(const std::string& text) {
    return has_digits_only(text) ? std::string() : "expected a whole number, found '" + text + "'";
}

/// An option for one number of a range, which its sentence and its error name.
template <class Number, class Target>
CLI::Option* add_number(Command& command, const std::string& name, Target& target, Number least, Number most,
                        const std::string& sentence) {
    const std::string range = "from " + text_of(least) + " to " + text_of(most);
    return command.add_option(name, target, sentence + ", " + range + ".")
        ->check([least, most, range](const std::string& text) {
            Number number{};
            const bool in_range =
                CLI::detail::lexical_cast(text, number) && number >= least && number <= most;
            return in_range ? std::string() : "expected a number " + range + ", found '" + text + "'";
        })
        ->type_name("N");
}

/// An option for one of some words, which its type's name tells.
CLI::Option* add_choice(Command& command, const std::string& name, const std::vector<std::string>& words,
                        const std::function<void(const std::string&)>& take, const std::string& sentence) {
    const std::string list = CLI::detail::join(words, "|");
    return command.add_option_function<std::string>(name, take, sentence)
        ->check([words, list](const std::string& text) {
            const bool known = std::find(words.begin(), words.end(), text) != words.end();
            return known ? std::string() : "expected " + list + ", found '" + text + "'";
        })
        ->type_name(list);
}

CLI::Option* add_file(Command& command, const std::string& name, std::filesystem::path& target,
                      const std::string& sentence) {
    return command.add_option(name, target, sentence)->type_name("FILE");
}

CLI::Option* add_folder(Command& command, const std::string& name, std::filesystem::path& target,
                        const std::string& sentence) {
    return command.add_option(name, target, sentence)->type_name("DIR");
}

void add_vector(Command& command, const std::string& name, std::optional<glm::dvec3>& target,
                const std::string& sentence) {
    command
        .add_option_function<std::string>(
            name,
            [name, &target](const std::string& text) {
                const auto numbers = parse_numbers<double, 3>(name, text, ',', "X,Y,Z");
                target = glm::dvec3(numbers[0], numbers[1], numbers[2]);
            },
            sentence)
        ->type_name("X,Y,Z")
        ->group(kCamera);
}

CLI::Option* add_device(Command& command, std::optional<int>& device) {
    return command.add_option("--device", device, "Draw on this EGL device, counted from 0.")
        ->check(is_whole_number)
        ->type_name("N")
        ->default_str("the first that works")
        ->group(kDrawing);
}

CLI::Option* add_size(Command& command, int& width, int& height) {
    return command
        .add_option_function<std::string>(
            "--size",
            [&width, &height](const std::string& text) {
                const auto size = parse_numbers<int, 2>("--size", text, 'x', "WxH");
                if (size[0] < 1 || size[1] < 1)
                    throw CLI::ValidationError("--size", "expected one pixel at least, found '" + text + "'");
                width = size[0];
                height = size[1];
            },
            "Draw this many pixels, width and height.")
        ->type_name("WxH")
        ->default_str(std::to_string(width) + "x" + std::to_string(height));
}

/// The log's level, which a command has that goes on for long.
void add_log_level(Command& command) {
    add_choice(
        command, "--log-level", {"debug", "info", "warning", "error", "off"},
        [](const std::string& text) { spdlog::set_level(spdlog::level::from_str(text)); },
        "Log events of this level and above.")
        ->default_str("info")
        ->group(kGeneral);
}

/// What files of scenes do not tell.
void add_reading(Command& command, io::ReadOptions& read) {
    command
        .add_option("--textures", read.texture_folders,
                    "Look in this folder for textures that are not where the scene says, nor beside it.")
        ->check([](const std::string& path) {
            return std::filesystem::is_directory(path) ? std::string() : "there is no folder '" + path + "'";
        })
        ->allow_extra_args(false)  // what follows the one is the scene
        ->type_name("DIR")
        ->group(kScene);
    add_choice(
        command, "--up-axis", {"y", "z"}, [&read](const std::string& axis) { read.z_up = axis == "z"; },
        "Take this axis for up in OBJ, STL and PLY files, which do not tell.")
        ->default_str("y")
        ->group(kScene);
}

void add_studio(Command& command, io::ReadOptions& read) {
    add_choice(
        command, "--studio", {"on", "off"},
        [&read](const std::string& text) { read.studio = text == "on" ? io::Studio::on : io::Studio::off; },
        "Show the scene in a studio, which it reflects, with a shadow on the ground, unless it has a "
        "background of its own.")
        ->default_str("on for scenes without lights in other formats than scene text")
        ->group(kScene);
}

std::vector<Entry> statuses(const std::string& done,
                            const std::string& wrong_usage = "The command line is wrong.") {
    return {{std::to_string(kDone), done},
            {std::to_string(kFailed), "The command failed. One sentence on standard error says why."},
            {std::to_string(kWrongUsage), wrong_usage + " One sentence on standard error says where."}};
}

Entry state_folder(const std::string& what) {
    return {"XDG_STATE_HOME",
            "Folder for " + what + ", in its subfolder vrut-preview. Default: ~/.local/state."};
}

CLI::Option* add_nats(Command& command, std::string& url, const std::string& sentence) {
    return command.add_option("--nats", url, sentence)->type_name("URL")->group(kNetwork);
}

CLI::Option* add_room(Command& command, std::string& room) {
    return command.add_option("--room", room, "The name of the room there.")
        ->check([](const std::string& text) {
            return protocol::is_room_name(text)
                       ? std::string()
                       : "expected 1 to 32 lower-case letters, digits and hyphens, found '" + text + "'";
        })
        ->type_name("NAME")
        ->group(kNetwork);
}

CLI::Option* add_listen(Command& command, NetworkArguments& arguments, const std::string& sentence) {
    return command.add_option("--listen", arguments.listen, sentence)
        ->type_name("ADDR:PORT")
        ->group(kNetwork);
}

CLI::Option* add_certificate(Command& command, NetworkArguments& arguments) {
    auto* const certificate =
        add_file(command, "--tls-cert", arguments.tls_cert,
                 "Speak HTTPS with this certificate, in PEM, followed by those of its authorities.")
            ->group(kNetwork);
    auto* const key = add_file(command, "--tls-key", arguments.tls_key, "The certificate's key, in PEM.")
                          ->group(kNetwork)
                          ->needs(certificate);
    return certificate->needs(key);
}

CLI::Option* add_token_file(Command& command, NetworkArguments& arguments) {
    return add_file(
               command, "--token-file", arguments.token_file,
               R"(Read the tokens from this JSON file, {"control": TOKEN, "view": TOKEN}, which nobody but its )"
               R"(owner may read.)")
        ->group(kAccess);
}

/// Where it listens, and what it speaks TLS with.
void add_network(Command& command, NetworkArguments& arguments) {
    add_listen(command, arguments, "Listen at this address; port 0 is any free port.")->capture_default_str();
    auto* const lan =
        command
            .add_flag("--lan", arguments.lan,
                      "Serve the network: listen at 0.0.0.0:8080 if --listen is not given, and speak HTTPS "
                      "with other devices, with certificates of an authority that is made once and kept.")
            ->group(kNetwork);
    add_certificate(command, arguments)->excludes(lan);
    add_number(command, "--max-clients", arguments.max_clients, 1, 10000,
               "Accept N clients at a time, and 16 more that are hosts or present")
        ->capture_default_str()
        ->group(kNetwork);
    add_token_file(command, arguments);
    command
        .add_option("--allow-origin", arguments.allowed_origins,
                    "Accept pages of this origin, besides the server's own.")
        ->allow_extra_args(false)  // what follows the one is the scene
        ->type_name("ORIGIN")
        ->group(kAccess);
}

/// Where those find it who monitor it: by default nowhere.
void add_monitoring(Command& command, NetworkArguments& arguments) {
    arguments.listen.clear();
    auto* const listen = add_listen(command, arguments,
                                    "Answer /healthz, /readyz and /metrics at this address; port 0 is any "
                                    "free port.");
    add_certificate(command, arguments)->needs(listen);
    add_token_file(command, arguments)->needs(listen);
}

/// Calls what runs the command, listening to the network with --lan.
template <class Run, class Arguments>
std::function<void()> with_network(const Command& command, Arguments& arguments, Run run) {
    return [&arguments, run, listen = command.get_option("--listen")] {
        if (arguments.network.lan && listen->count() == 0) arguments.network.listen = "0.0.0.0:8080";
        run(arguments);
    };
}

std::shared_ptr<Command> describe_serve(ServeArguments& arguments) {
    auto command = std::make_shared<Command>("Serve a scene to tablets, hosts and scripts.", "serve");
    command->description = {
        "The server draws the scene without a window, and streams frames of it to web pages, hosts and "
        "scripts. It prints the address of its page when it accepts connections, and logs to standard error. "
        "SIGINT, SIGTERM and SIGHUP end it; with --tls-cert, SIGHUP makes it read certificate and key again.",
        "Beyond this machine, clients need a token. Where neither a file nor the environment has one, the "
        "server makes two, and prints the addresses with their tokens, one of them as a QR code.",
        "Where the server speaks HTTPS, plain HTTP is served to this machine alone. With --lan, the page "
        "/trust shows other devices how to trust the server's authority, which they need once."};
    add_file(*command, "SCENE", arguments.scene, "Serve this scene file.")->default_str("the car");
    add_network(*command, arguments.network);
    auto* const nats =
        add_nats(*command, arguments.nats, "Share the room over this NATS server (see 'edge').");
    add_room(*command, arguments.room)->needs(nats);
    nats->needs(command->get_option("--room"));
    add_folder(*command, "--scenes", arguments.scenes,
               "Let clients open the scenes in this folder and below.")
        ->group(kScene);
    add_reading(*command, arguments.read);
    add_studio(*command, arguments.read);
    add_folder(*command, "--record", arguments.record, "Let clients record sessions into this folder.")
        ->group(kScene);
    add_device(*command, arguments.device);
    add_log_level(*command);
    command->environment = {
        {"VRUT_PREVIEW_CONTROL_TOKEN",
         "Token of clients that may steer, of 16 to 1000 bytes. That of --token-file has priority."},
        {"VRUT_PREVIEW_VIEW_TOKEN", "Token of clients that only watch, likewise."},
        {"CREDENTIALS_DIRECTORY", "The group may read a token file in this folder, which systemd makes."},
        state_folder("measured levels, what clients have changed of scenes, and the authority of --lan")};
    command->exit_statuses = statuses("A signal has ended the server.");
    command->examples = {{"vrut-preview serve", "Serve the car at http://127.0.0.1:8080/."},
                         {"vrut-preview serve my.glb --lan", "Serve a scene to the tablets of a network."},
                         {"vrut-preview serve my.vrut --scenes scenes --record recordings",
                          "Let clients open other scenes, and record sessions."}};
    command->callback(with_network(*command, arguments, serve_command));
    return command;
}

std::shared_ptr<Command> describe_edge(EdgeArguments& arguments) {
    auto command = std::make_shared<Command>("Serve the rooms of other servers to clients.", "edge");
    command->description = {
        "An edge brings clients to the rooms that servers share with 'serve --nats --room': the page of a "
        "room "
        "is at /rooms/NAME/. It draws nothing itself, and sends on each image that a server has encoded "
        "once. "
        "The more edges there are, the more clients can watch. "
        "SIGINT, SIGTERM and SIGHUP end it; with --tls-cert, SIGHUP makes it read certificate and key again.",
        "Clients need the tokens of the room. The edge's own tokens are for those who monitor it. Without "
        "them, an edge that other machines can reach keeps its metrics to itself."};
    add_nats(*command, arguments.nats, "Find the rooms at this NATS server.")->required();
    add_network(*command, arguments.network);
    add_log_level(*command);
    command->environment = {
        {"VRUT_PREVIEW_CONTROL_TOKEN, VRUT_PREVIEW_VIEW_TOKEN",
         "Tokens of those who monitor the edge, of 16 to 1000 bytes. Those of --token-file have priority."},
        {"CREDENTIALS_DIRECTORY", "The group may read a token file in this folder, which systemd makes."},
        state_folder("the authority of --lan")};
    command->exit_statuses = statuses("A signal has ended the edge.");
    command->examples = {
        {"vrut-preview edge --nats nats://127.0.0.1 --listen 127.0.0.1:8090",
         "Serve rooms at http://127.0.0.1:8090/rooms/NAME/."},
        {"vrut-preview edge --nats nats://127.0.0.1 --lan", "Serve rooms to the tablets of a network."},
        {"vrut-preview edge --nats nats://127.0.0.1 --max-clients 1000", "Let a thousand clients in."}};
    command->callback(with_network(*command, arguments, edge_command));
    return command;
}

/// Options that stand for patches of the state.
void add_patches(Command& command, RenderArguments& arguments) {
    const auto adds = [&](const std::string& name, const std::string& before, const std::string& after) {
        return [&arguments, name, before, after](const std::string& text) {
            arguments.patches.emplace_back(name, before + text + after);
        };
    };
    add_choice(command, "--mode", {"realistic", "stylized"},
               adds("--mode", R"({"renderer":{"mode":")", "\"}}"), "Draw the scene in this way.")
        ->group(kScene);
    command
        .add_flag_callback(
            "--wireframe",
            [&arguments] {
                arguments.patches.emplace_back("--wireframe", R"({"renderer":{"wireframe":true}})");
            },
            "Draw edges only.")
        ->group(kScene);
    command
        .add_option_function<std::int64_t>(
            "--select",
            [add = adds("--select", R"({"selection":{"node":)", "}}")](std::int64_t node) {
                add(std::to_string(node));
            },
            "Draw the node of this id as selected.")
        ->check(is_whole_number)
        ->type_name("ID")
        ->group(kScene);
    const auto is_id = [](const std::string& other) {
        return [other](const std::string& text) {
            return has_digits_only(text) || text == other
                       ? std::string()
                       : "expected a node's id or " + other + ", found '" + text + "'";
        };
    };
    command
        .add_option_function<std::string>(
            "--light", adds("--light", R"({"lights":{"active":")", "\"}}"),
            "Light the scene by the light node of this id, or by the headlight.")
        ->check(is_id("headlight"))
        ->type_name("ID|headlight")
        ->group(kScene);
    command
        .add_option_function<std::string>(
            "--background",
            [add = adds("--background", R"({"backgrounds":{"active":")", "\"}}")](const std::string& id) {
                add(id == "none" ? "color" : id);
            },
            "Draw the background node of this id, or none but the plain colour.")
        ->check(is_id("none"))
        ->type_name("ID|none")
        ->group(kScene);
}

void add_camera(Command& command, RenderArguments& arguments) {
    add_file(command, "--camera", arguments.camera_file,
             "Read the camera from this JSON file, in the form that it has in the state document.")
        ->group(kCamera);
    add_vector(command, "--eye", arguments.eye, "Look from this point.");
    add_vector(command, "--focus", arguments.focus, "Look at this point.");
    add_vector(command, "--up", arguments.up, "Hold this direction upright.");
    add_number(command, "--fov", arguments.fov, 1.0, 170.0, "Draw a vertical field of view of N degrees")
        ->group(kCamera);
}

template <class Number>
CLI::Option* add_images_per_second(Command& command, Number& target) {
    return add_number(command, "--fps", target, 1, 240, "Show N images of the film a second")
        ->default_str(std::to_string(kImagesPerSecond))
        ->group(kOutput);
}

void add_film(Command& command, RenderArguments& arguments) {
    auto* keyframes =
        add_file(command, "--keyframes", arguments.keyframes,
                 "Draw the flight of this JSON file, which has the members of the protocol's message 'fly'.")
            ->group(kCamera);
    add_number(command, "--frames", arguments.frames, 2, kMostImages, "Draw N images of the flight")
        ->default_str("as many as --fps shows while it lasts")
        ->needs(keyframes)
        ->group(kCamera);
    add_images_per_second(command, arguments.fps);
    add_nats(command, arguments.nats, "Let the workers of this NATS server draw (see 'worker').")
        ->excludes(command.get_option("--textures"));
}

/// After add_drawing().
void add_cues(Command& command, RenderArguments& arguments) {
    auto* cues = add_file(command, "--cues", arguments.cues,
                          "Draw the cues of this list, one after the other (see 'cues').")
                     ->group(kCamera);
    for (const char* other : {"--keyframes", "--camera", "--eye", "--focus", "--up", "--fov", "--frames",
                              "--nats", "--detail", "--reference", "--ids", "--stats"})
        cues->excludes(command.get_option(other));
    add_number(command, "--hold", arguments.hold, 0.0, 3600.0, "Stay N seconds at each cue")
        ->capture_default_str()
        ->needs(cues)
        ->group(kCamera);
}

/// What the image is drawn with, and what is written besides. After add_film().
void add_drawing(Command& command, RenderArguments& arguments) {
    add_number(command, "--samples", arguments.samples, 1, 4096, "Draw N samples a pixel")
        ->capture_default_str()
        ->group(kDrawing);
    auto* detail = add_number(command, "--detail", arguments.detail, 0.0, 1000.0,
                              "Draw fewer triangles: surfaces may lie off by N pixels")
                       ->capture_default_str()
                       ->group(kDrawing);
    auto* reference = command
                          .add_flag("--reference", arguments.reference,
                                    "Trace rays in double precision, without a graphics card.")
                          ->excludes(detail)
                          ->excludes(command.get_option("--nats"))
                          ->group(kDrawing);
    add_file(command, "--float", arguments.unrounded,
             "Write the values of --reference before they are rounded too, as a PFM image.")
        ->needs(reference)
        ->excludes(command.get_option("--keyframes"))
        ->group(kOutput);
    add_file(command, "--ids", arguments.ids,
             "Write the node ids at the centres of the pixels too, as a PNG image: 24 bits, white for none.")
        ->excludes(command.get_option("--keyframes"))
        ->excludes(command.get_option("--nats"))
        ->group(kOutput);
    command.add_flag("--stats", arguments.stats, "Print what drawing took, as JSON.")
        ->excludes(reference)
        ->excludes(command.get_option("--nats"))
        ->group(kOutput);
    add_device(command, arguments.device)->excludes(command.get_option("--nats"));
}

std::shared_ptr<Command> describe_render(RenderArguments& arguments) {
    auto command = std::make_shared<Command>("Draw an image of a scene.", "render");
    command->description = {
        "The image shows the first view of the scene, unless options choose another one. --eye, --focus, "
        "--up and --fov have priority over --camera, and --camera has priority over --set.",
        "With --keyframes it draws a film: the images of a flight, in equal times from its start to its end. "
        "With "
        "--cues it draws the film of a presentation. "
        "Where --output ends in .mp4 they become one file, H.264 where libx264 is there, else MPEG-4. Else "
        "their names have a number behind that of --output: film-0001.png, film-0002.png and so on."};
    add_file(*command, "SCENE", arguments.scene, "Draw this scene file.")->required();
    add_file(*command, "-o,--output", arguments.output,
             "Write the image to this file, whose name ends in .png, .jpg or .jpeg, or the film to one that "
             "ends in "
             ".mp4.")
        ->required()
        ->group(kOutput);
    add_size(*command, arguments.width, arguments.height)->group(kOutput);
    add_number(*command, "--jpeg-quality", arguments.jpeg_quality, 1, 100, "Write JPEG of this quality")
        ->capture_default_str()
        ->group(kOutput);
    add_camera(*command, arguments);
    command->add_option("--set", arguments.set, "Change the state document by this JSON merge patch.")
        ->type_name("JSON")
        ->group(kScene);
    add_patches(*command, arguments);
    add_reading(*command, arguments.read);
    add_studio(*command, arguments.read);
    add_film(*command, arguments);
    add_drawing(*command, arguments);
    add_cues(*command, arguments);
    command->exit_statuses = statuses("The image is written.");
    command->examples = {{"vrut-preview render my.glb -o my.png", "Draw the first view of a scene."},
                         {"vrut-preview render my.vrut -o my.jpg --size 1920x1080 --eye 3,2,5",
                          "Draw it from a point, in another size."},
                         {"vrut-preview render mirror.vrut -o truth.png --size 320x180 --reference",
                          "Trace a scene with mirrors ray by ray."}};
    command->callback([&arguments] { render_command(arguments); });
    return command;
}

std::shared_ptr<Command> describe_worker(WorkerArguments& arguments) {
    auto command = std::make_shared<Command>("Draw images for others.", "worker");
    command->description = {
        "A worker takes images from a queue, draws them and sends them to where 'render --nats' waits for "
        "them. Any number of workers share a queue. When one dies, another draws its image after 5 s. "
        "SIGINT, "
        "SIGTERM and SIGHUP end a worker once its image is sent.",
        "A worker finds the scene of an image by the name of its file, and draws it only if the scene and "
        "its "
        "textures are the same as where the image was asked for.",
        "With --listen, the worker answers those who monitor it. Beyond the own machine, they need a token: "
        "give it with --token-file."};
    add_nats(*command, arguments.nats, "Take images from the queue of this NATS server, which has JetStream.")
        ->required();
    add_folder(*command, "--scenes", arguments.scenes, "Look for scenes in this folder and below.")
        ->required()
        ->group(kScene);
    add_device(*command, arguments.device);
    add_monitoring(*command, arguments.network);
    add_log_level(*command);
    command->environment = {
        {"VRUT_PREVIEW_CONTROL_TOKEN, VRUT_PREVIEW_VIEW_TOKEN",
         "Tokens of those who monitor the worker, of 16 to 1000 bytes. Those of --token-file have priority."},
        {"CREDENTIALS_DIRECTORY", "The group may read a token file in this folder, which systemd makes."}};
    command->exit_statuses = statuses("A signal has ended the worker.");
    command->examples = {{"vrut-preview worker --nats nats://127.0.0.1 --scenes scenes", "Draw what comes."},
                         {"vrut-preview worker --nats nats://127.0.0.1 --scenes scenes --device 0",
                          "Draw on the first graphics card."},
                         {"vrut-preview worker --nats nats://127.0.0.1 --scenes . --listen 127.0.0.1:8100",
                          "Count the images at http://127.0.0.1:8100/metrics."}};
    command->callback([&arguments] { worker_command(arguments); });
    return command;
}

void add_session_film(Command& command, ReplayArguments& arguments) {
    auto* film = add_file(command, "--film", arguments.film,
                          "Write what the session showed as a film to this file, whose name ends in .mp4; or "
                          "as numbered images, where it ends in .png, .jpg or .jpeg.")
                     ->excludes(command.get_option("--out"))
                     ->group(kOutput);
    add_size(command, arguments.width, arguments.height)
        ->default_str("that of the first view, with even sides")
        ->needs(film)
        ->group(kOutput);
    add_images_per_second(command, arguments.fps)->needs(film);
}

std::shared_ptr<Command> describe_replay(ReplayArguments& arguments) {
    auto command = std::make_shared<Command>("Replay a recorded session.", "replay");
    command->description = {
        "The command prints the camera at the end of the session, as JSON: the same one as in the session, "
        "to "
        "the last bit. A server records sessions where it is started with --record."};
    add_file(*command, "LOG", arguments.log, "Replay this event log (.jsonl).")->required();
    add_file(*command, "--scene", arguments.scene, "Replay on this scene file.")
        ->default_str("the one that was recorded, beside the log or among the scenes of the program")
        ->group(kScene);
    add_studio(*command, arguments.read);
    add_folder(*command, "--out", arguments.frames,
               "Write the frames of the session to this folder, as JPEG.")
        ->group(kOutput);
    add_session_film(*command, arguments);
    add_device(*command, arguments.device);
    command->exit_statuses = statuses("The session is replayed.");
    command->examples = {
        {"vrut-preview replay recordings/session.jsonl", "Print the last camera of a session."},
        {"vrut-preview replay recordings/session.jsonl --out frames", "Draw its frames too."},
        {"vrut-preview replay recordings/session.jsonl --film film.png --fps 5",
         "Draw five images of each second."}};
    command->callback([&arguments] { replay_command(arguments); });
    return command;
}

std::shared_ptr<Command> describe_info(InfoArguments& arguments) {
    auto command = std::make_shared<Command>("Print what a scene holds.", "info");
    command->description = {
        "The command prints the size of the scene, notices about what is not shown of it, and its nodes."};
    add_file(*command, "SCENE", arguments.scene, "Read this scene file.")->required();
    command->add_flag("--json", arguments.json, "Print JSON.")->group(kOutput);
    command->exit_statuses = statuses("The scene can be read.");
    command->examples = {{"vrut-preview info my.glb", "Print the nodes of a scene."},
                         {"vrut-preview info my.glb | grep geometry", "Print those with triangles."},
                         {"vrut-preview info my.glb --json >my.json", "Write them to a file for scripts."}};
    command->callback([&arguments] { info_command(arguments); });
    return command;
}

std::shared_ptr<Command> describe_convert(ConvertArguments& arguments) {
    auto command = std::make_shared<Command>("Write a scene in another format.", "convert");
    command->description = {
        "The ending of a file's name says its format. What OUT does not hold is said on standard error, a "
        "line "
        "each."};
    add_file(*command, "IN", arguments.in, "Read this scene file: " + io::read_extensions() + ".")
        ->required();
    add_file(*command, "OUT", arguments.out, "Write this scene file: " + io::written_extensions() + ".")
        ->required();
    add_reading(*command, arguments.read);
    command->exit_statuses =
        statuses("The file is written.", "The command line is wrong, as where OUT is of no format or is IN.");
    command->examples = {
        {"vrut-preview convert my.obj my.glb", "Write glTF."},
        {"vrut-preview convert my.glb my.vrut", "Write scene text, which can be read and edited."},
        {"vrut-preview convert my.vrut my.stl 2>lost.txt", "Keep the list of what is lost."}};
    command->callback([&arguments] { convert_command(arguments); });
    return command;
}

std::shared_ptr<Command> describe_compare(CompareArguments& arguments) {
    auto command = std::make_shared<Command>("Measure how far two images are apart.", "compare");
    command->description = {
        "The command prints the largest difference, RMS, PSNR, how many pixels are off, and FLIP, which "
        "weighs differences as a viewer sees them. The images are PNG, JPEG, WebP, TIFF, BMP, GIF or TGA "
        "files "
        "of the same size."};
    add_file(*command, "IMAGE1", arguments.a, "Compare this image.")->required();
    add_file(*command, "IMAGE2", arguments.b, "Compare it with this one.")->required();
    command->add_flag("--json", arguments.json, "Print JSON.")->group(kOutput);
    add_file(*command, "--map", arguments.map,
             "Write the FLIP error of each pixel to this PNG file, from black for 0 to white for 1.")
        ->group(kOutput);
    command->exit_statuses = statuses("The images are compared, whether or not they differ.");
    command->examples = {
        {"vrut-preview compare my.png truth.png", "Print the differences."},
        {"vrut-preview compare my.png truth.png --json", "Print them for scripts."},
        {"vrut-preview compare my.png truth.png --map flip.png", "Draw where the images differ."}};
    command->callback([&arguments] { compare_command(arguments); });
    return command;
}

std::shared_ptr<Command> describe_cues(CuesArguments& arguments) {
    auto command = std::make_shared<Command>("Check a list of cues against a scene.", "cues");
    command->description = {
        "A list of cues is the file of a presentation, which the page saves. The command prints a sentence "
        "for each node, light, background or value in it that does not go with the scene."};
    command->add_option("ACTION", arguments.action, "What to do: check.")
        ->required()
        ->check(CLI::IsMember({"check"}));
    add_file(*command, "LIST", arguments.list, "The list of cues.")->required();
    add_file(*command, "SCENE", arguments.scene, "The scene that it is for.")->required();
    add_reading(*command, arguments.read);
    command->exit_statuses = statuses("All of the list goes with the scene.",
                                      "The command line is wrong, as where ACTION is not check.");
    command->examples = {{"vrut-preview cues check my-cues.json my.glb", "Print what would go wrong."},
                         {"vrut-preview cues check my-cues.json my.glb >wrong.txt", "Keep that in a file."},
                         {"vrut-preview cues check my-cues.json my.obj --up-axis z",
                          "Check it against a scene whose z axis leads up."}};
    command->callback([&arguments] { cues_command(arguments); });
    return command;
}

CLI::Option* add_glass(Command& command, ChartArguments& arguments) {
    auto* glass = command
                      .add_option("--glass", arguments.sessions,
                                  "Compute the error at the glass in this recorded session.")
                      ->type_name("LOG")
                      ->allow_extra_args(false)
                      ->group(kMeasurement);
    command
        .add_option("--link", arguments.links,
                    "Over this link: round trip in ms, Mbit/s, percent of packets lost. Without it, a LAN "
                    "(1,1000), Wi-Fi (20,20), bad Wi-Fi (100,2) and a phone network (200,1).")
        ->type_name("RTT,RATE[,LOSS]")
        ->allow_extra_args(false)
        ->needs(glass)
        ->group(kMeasurement);
    add_number(command, "--latency-target", arguments.latency_target_ms, 5.0, 1000.0,
               "Let the server choose levels that take up to N ms")
        ->capture_default_str()
        ->needs(glass)
        ->group(kMeasurement);
    add_number(command, "--every", arguments.every, 1, 1000, "Judge every Nth of 60 refreshes a second")
        ->capture_default_str()
        ->needs(glass)
        ->group(kMeasurement);
    command
        .add_flag("--each-level", arguments.each_level,
                  "Compute it with each level alone, too: how time, bytes and error depend on each other.")
        ->needs(glass)
        ->group(kMeasurement);
    return glass;
}

std::shared_ptr<Command> describe_chart(ChartArguments& arguments) {
    auto command = std::make_shared<Command>("Measure speed against accuracy.", "chart");
    command->description = {
        "With --out, the command measures many settings of the renderer, and draws charts of them by "
        "gnuplot. "
        "With --calibrate, it measures the levels that a server draws the scene with on this machine, and "
        "stores them for it. With --glass, it computes what a client would have seen of a recorded session: "
        "how far, by mean FLIP, each refresh of its screen lies from the image of a server without delay. "
        "One of the three is required."};
    command->add_option("SCENE", arguments.scenes, "Measure these scene files.")
        ->type_name("FILE")
        ->default_str("the car");
    add_studio(*command, arguments.read);
    auto* out =
        add_folder(*command, "--out", arguments.out,
                   "Write charts, tables and a page to this folder. What it holds is not measured again.")
            ->group(kOutput);
    auto* calibrate =
        command
            ->add_flag("--calibrate", arguments.calibrate, "Measure the levels of one scene, and store them.")
            ->group(kOutput);
    out->excludes(calibrate);
    auto* glass = add_glass(*command, arguments)->excludes(calibrate);
    add_size(*command, arguments.width, arguments.height)->group(kMeasurement);
    add_number(*command, "--frames", arguments.frames, 1, 1000, "Draw N frames of each setting")
        ->capture_default_str()
        ->excludes(glass)
        ->group(kMeasurement);
    command
        ->add_option("--triangles", arguments.most_triangles,
                     "Measure generated scenes of up to N triangles too.")
        ->check(is_whole_number)
        ->type_name("N")
        ->capture_default_str()
        ->excludes(glass)
        ->group(kMeasurement);
    add_device(*command, arguments.device);
    command->environment = {state_folder("measured levels")};
    command->exit_statuses = statuses("The measurements are written.");
    command->examples = {
        {"vrut-preview chart my.vrut --calibrate", "Store the levels of a scene, in half a minute."},
        {"vrut-preview chart my.vrut --out charts", "Draw all charts of a scene, in some hours."},
        {"vrut-preview chart room.vrut --glass session.jsonl --link 100,2",
         "Compute the error at the glass over bad Wi-Fi."}};
    command->callback([&arguments] {
        if (!arguments.calibrate && arguments.out.empty() && arguments.sessions.empty())
            throw CLI::RequiredError("--out, --calibrate or --glass");
        if ((arguments.calibrate || !arguments.sessions.empty()) && arguments.scenes.size() > 1)
            throw CLI::ValidationError(
                arguments.calibrate ? "--calibrate" : "--glass",
                "expected one scene, found " + std::to_string(arguments.scenes.size()));
        chart_command(arguments);
    });
    return command;
}

}  // namespace

std::shared_ptr<Command> describe_program(Arguments& arguments) {
    auto program = std::make_shared<Command>("Preview the scene of a CAVE on tablets.", "vrut-preview");
    program->description = {
        "The program serves a scene to tablets, whose web page steers the camera; and draws, converts, "
        "replays, compares and measures scenes from the command line. It draws without a window, on a "
        "graphics card or in software.",
        "Scene files end in " + io::read_extensions() + ". --help after a command prints its options."};
    program->set_version_flag("--version", "vrut-preview " VRUT_VERSION, "Print the version.")
        ->group(kGeneral);
    program->require_subcommand(1);
    program
        ->add_option_function<std::string>(
            "--write-manual",
            [program = program.get()](const std::string& folder) {
                write_manual(*program, VRUT_VERSION, folder);
                throw CLI::Success();
            },
            "Write the manual pages and the completion for Bash below this folder.")
        ->group("");  // for the build
    program->environment = {
        {"VRUT_PREVIEW_CONTROL_TOKEN, VRUT_PREVIEW_VIEW_TOKEN", "Tokens of the clients of serve."},
        state_folder("what serve and chart keep")};
    program->exit_statuses = statuses("The command has done its work.");
    program->examples = {{"vrut-preview serve", "Serve the car at http://127.0.0.1:8080/."},
                         {"vrut-preview render my.glb -o my.png", "Draw an image of a scene."},
                         {"vrut-preview serve --help", "Print the options of a command."}};
    program->add_subcommand(describe_serve(arguments.serve));
    program->add_subcommand(describe_edge(arguments.edge));
    program->add_subcommand(describe_render(arguments.render));
    program->add_subcommand(describe_worker(arguments.worker));
    program->add_subcommand(describe_replay(arguments.replay));
    program->add_subcommand(describe_info(arguments.info));
    program->add_subcommand(describe_convert(arguments.convert));
    program->add_subcommand(describe_compare(arguments.compare));
    program->add_subcommand(describe_cues(arguments.cues));
    program->add_subcommand(describe_chart(arguments.chart));
    return program;
}

}  // namespace vrut::server::commands
