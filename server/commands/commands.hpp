#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/read_scene.hpp"

/// What the program's subcommands do. Each throws std::exception with one sentence; main prints it.
namespace vrut::server::commands {

/// Of commands that show scenes.
inline const io::ReadOptions kShown{.studio = io::Studio::automatic};

/// How clients reach a server, and who may.
struct NetworkArguments {
    std::string listen = "127.0.0.1:8080";
    bool lan = false;                         ///< HTTPS by an authority of the server's own
    std::filesystem::path tls_cert, tls_key;  ///< HTTPS by these; both or none
    std::size_t max_clients = 64;
    std::filesystem::path token_file;
    std::vector<std::string> allowed_origins;
};

struct ServeArguments {
    std::filesystem::path scene;  ///< empty: the car
    io::ReadOptions read = kShown;
    NetworkArguments network;
    std::string nats, room;  ///< the address of NATS, and the room's name there; empty: none
    std::optional<int> device;
    std::filesystem::path scenes;  ///< what clients may open; empty: nothing
    std::filesystem::path record;  ///< where recordings go; empty: nowhere
};
void serve_command(const ServeArguments& arguments);

struct EdgeArguments {
    NetworkArguments network;
    std::string nats;  ///< the address of NATS
};
void edge_command(const EdgeArguments& arguments);

inline constexpr int kImagesPerSecond = 30;  ///< of films, where nothing else is asked for
inline constexpr int kMostImages = 100'000;  ///< of a flight

struct RenderArguments {
    std::filesystem::path scene, output;
    io::ReadOptions read = kShown;
    int width = 1280, height = 720;
    int samples = 4;
    double detail = 0;
    int jpeg_quality = 90;
    std::filesystem::path camera_file;
    std::optional<glm::dvec3> eye, focus, up;
    std::optional<double> fov;
    std::filesystem::path keyframes;  ///< of a film; empty: one image
    int frames = 0;                   ///< of the film; 0: as many as `fps` makes of its time
    std::filesystem::path cues;       ///< a list of them, of a film; empty: none
    double hold = 2;                  ///< seconds at each cue
    std::optional<int> fps;           ///< images a second
    std::string nats;  ///< the address of NATS, whose workers draw the film; empty: this machine
    std::string set;   ///< a merge patch on the state
    std::vector<std::pair<std::string, std::string>>
        patches;  ///< further ones, with the option that they are of
    std::optional<int> device;
    bool stats = false;
    bool reference = false;  ///< by the reference renderer, without a GPU
    std::filesystem::path unrounded,
        ids;  ///< further pictures: of the reference's values, of node ids; or empty
};
void render_command(const RenderArguments& arguments);

struct WorkerArguments {
    std::string nats;              ///< the address of NATS
    std::filesystem::path scenes;  ///< where the scenes of the jobs are
    std::optional<int> device;
    NetworkArguments network;  ///< for those who monitor it; listens nowhere if that is empty
};
void worker_command(const WorkerArguments& arguments);

struct ReplayArguments {
    std::filesystem::path log;
    std::filesystem::path scene;  ///< empty: the log's own, looked for beside it and among the program's
    io::ReadOptions read = kShown;
    std::filesystem::path frames;  ///< folder for the frames; empty: none are drawn
    std::filesystem::path film;    ///< of the session; empty: none
    int width = 0, height = 0;     ///< of the film; 0: those of the session's first view
    int fps = kImagesPerSecond;    ///< of the film
    std::optional<int> device;
};
void replay_command(const ReplayArguments& arguments);

struct InfoArguments {
    std::filesystem::path scene;
    bool json = false;
};
void info_command(const InfoArguments& arguments);

struct ConvertArguments {
    std::filesystem::path in, out;
    io::ReadOptions read;
};
/// What the new file does not hold goes to standard error, a line each.
void convert_command(const ConvertArguments& arguments);

struct CompareArguments {
    std::filesystem::path a, b;
    std::filesystem::path map;  ///< FLIP's errors as a grey PNG; empty: none is written
    bool json = false;
};
void compare_command(const CompareArguments& arguments);

/// What of a list of cues does not go with a scene.
struct CuesArguments {
    std::string action;  ///< "check", the only one
    std::filesystem::path list, scene;
    io::ReadOptions read = kShown;
};
/// Throws std::runtime_error where there is anything.
void cues_command(const CuesArguments& arguments);

struct ChartArguments {
    std::vector<std::filesystem::path> scenes;  ///< empty: the car
    io::ReadOptions read = kShown;
    std::filesystem::path out;
    bool calibrate = false;                       ///< the server's table alone
    std::vector<std::filesystem::path> sessions;  ///< the error at the glass in these, and nothing else
    std::vector<std::string> links;               ///< over these; none: the usual ones
    double latency_target_ms = 50;                ///< that the server holds in them
    int every = 1;                                ///< refresh of them is judged
    bool each_level = false;                      ///< alone, too
    int width = 1280, height = 720;
    int frames = 12;  ///< of each setting
    std::uint64_t most_triangles = 10'000'000;
    std::optional<int> device;
};
/// In a program of its own, vrut-preview-chart: most who use this program chart nothing, and none waits until
/// that is compiled. Here it takes the place of this process; throws std::runtime_error if it is not there.
void chart_command(const ChartArguments& arguments);

/// Where the program's scenes may lie, seen from the program: as installed, and as built.
std::vector<std::filesystem::path> scene_folders();
/// The car, in one of them. Throws where it is in neither.
std::filesystem::path default_scene();

}  // namespace vrut::server::commands
