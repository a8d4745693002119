#pragma once

#include <array>
#include <atomic>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/watchdog.hpp"
#include "detail_levels.hpp"
#include "engine/encoder.hpp"
#include "engine/level_choice.hpp"
#include "engine/mailbox.hpp"
#include "engine/pacing.hpp"
#include "engine/painter.hpp"
#include "engine/recording_writer.hpp"
#include "engine/scene_lookup.hpp"
#include "observe/live_stats.hpp"
#include "observe/metrics.hpp"
#include "room/room.hpp"
#include "scene/library.hpp"
#include "scene/loader.hpp"
#include "state.hpp"
#include "view.hpp"

namespace vrut::server::engine {

/// What the render thread tells the net thread after it has handled a batch of events.
struct EngineOutput {
    struct Owed {
        std::string client;
        std::int64_t frame = 0;  ///< this frame or a newer one answers one grant
    };
    std::shared_ptr<const protocol::StateDocument> document;  ///< the newest; null if unchanged
    std::string by;  ///< who made it and the revisions before it, down to by_since; empty: the server
    std::int64_t by_since = 0;
    std::vector<room::Answer> answers;
    std::vector<Owed> owed;
    std::vector<std::string> undrawn;  ///< whose picture cannot be drawn (PictureAsked::name)
    struct Handled {
        std::size_t bytes = 0, requests = 0;
    };
    std::map<std::string, Handled> handled;             ///< of messages, for each client
    std::optional<PictureSize> size;                    ///< of a picture of the view; none if unchanged
    std::shared_ptr<const std::string> stats, loading;  ///< messages for all; null if there is nothing new
    bool loads = false;                                 ///< with `loading`: it goes on

    bool empty() const {
        return !document && answers.empty() && owed.empty() && undrawn.empty() && handled.empty() && !size &&
               !stats && !loading;
    }
};

struct EngineCallbacks {
    std::function<void(EngineOutput)> on_output;  ///< on the render thread
    /// Frames and snapshots (which have a `client`), on an encode thread.
    std::function<void(std::shared_ptr<const EncodedPicture>)> on_encoded;
    std::function<void(const std::string& why)> on_failure;  ///< on any of them: nothing more will be drawn
};

struct EngineOptions {
    scene::LoadedScene scene;
    scene::SceneLibrary library;
    std::filesystem::path record_folder;
};

/// The render thread: owns the scene, the state and the camera, applies what clients say in the order in
/// which it came, and draws a picture when something changed and somebody waits for it.
class Engine {
public:
    /// Starts the thread; throws what `factory` throws, and where the scene does not fit. The first output
    /// holds the first document.
    Engine(EngineOptions options, PainterFactory factory, observe::Metrics& metrics,
           EngineCallbacks callbacks);
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    Mailbox& mailbox() { return mailbox_; }
    const std::string& description() const { return description_; }
    const PictureLimits& limits() const { return limits_; }
    /// Events that came and are not handled yet. From any thread.
    std::size_t events_waiting() const { return mailbox_.size() + taken_; }
    /// How long each of its threads has not come round, 0 where it waits for something to do. From any
    /// thread.
    std::array<std::pair<const char*, base::Clock::duration>, 3> silences() const {
        return {{{"render", heart_.silence()},
                 {"encode", encoder_.silence()},
                 {"snapshot encode", snapshot_encoder_.silence()}}};
    }
    /// Whether what draws can draw. From any thread.
    bool draws() const { return draws_; }

private:
    struct Client {
        int grants = 0;
        int owed = 0;                 ///< pictures that it has been promised, and that are not sent yet
        int window = 1;               ///< the grants that it keeps outstanding, as far as was seen
        std::int64_t last_frame = 0;  ///< newest that it has been promised
        std::int64_t handled = 0;     ///< highest message id
        int snapshots = 0;            ///< asked for and not sent yet
        std::deque<FrameSent> sent;   ///< each until it is answered: until another is asked for
        std::int64_t newest_sent = 0;
        bool tells = false;         ///< has asked for another picture after one
        std::int64_t answered = 0;  ///< the newest frame after which it did
        bool is_late = true;        ///< frames take longer to it than over a quick link, as far as is known
        base::Clock::time_point promised_at{};

        void owe(std::int64_t frame, base::Clock::time_point now) {
            --grants;
            ++owed;
            last_frame = frame;
            promised_at = now;
        }
    };
    struct Begun {
        std::int64_t frame = 0;
        std::size_t level = 0;
        double pixels = 0, drawn_ms = 0;
        base::Clock::time_point at;
    };
    struct Snapshot {
        room::PictureOrder order;
        Image image;
        Accumulation kept;
        int losses = 0;  ///< of the context, while it was drawn
    };
    enum class Painted { whole, given_up, lost };
    static constexpr int kMostLosses = 2;  // of the context, by one snapshot or scene

    void handle(const ClientJoined& joined);
    void handle(const ClientLeft& left);
    void handle(const ClientSaid& said);
    void handle(const FrameSent& sent);
    void handle(const SnapshotSent& sent);
    void handle(const PictureAsked& asked);
    void handle(const scene::SceneLoading& loading);
    void handle(const scene::SceneLoaded& loaded);
    void handle(const FileWorkDone& done);
    /// Takes what has come, after waiting for something until then.
    void receive(std::optional<base::Clock::time_point> until);
    /// Handles some of it: the clients in turn, so that none waits behind another's thousand.
    void handle_waiting();
    void attend();
    void say(const ClientSaid& said, const protocol::ClientMessage& message, Client& client);
    void grant(Client& client, const ClientSaid& said);
    void report();
    void connect_files(room::PresentationOptions& options);
    std::optional<protocol::Error> load(const SceneLookup::Found& found);
    std::optional<base::Clock::time_point> files_due() const;
    void check_files();
    room::Time time_of(base::Clock::time_point when) const {
        return std::chrono::duration_cast<room::Time>(when - start_);
    }

    // --- pictures
    /// The newest picture drawn shows what is to be seen now.
    bool shows_present() const;
    bool waits_for_newer(const std::string& name, const Client& client, base::Clock::time_point now) const;
    base::Clock::duration delivery_at_rest() const;
    base::Clock::duration delivery_of_moving() const;
    base::Clock::duration delivery_of(std::size_t level) const;
    bool is_held(const std::string& name, const Client& client, int still_samples,
                 base::Clock::time_point now) const;
    bool thin_lines() const;
    void serve_newest(base::Clock::time_point now);
    PacingDecision pace(base::Clock::time_point now);
    void step();
    void fly();
    PictureSize present_size() const;
    void tell(const protocol::Loading& loading);
    void wait_for_event(std::optional<base::Clock::time_point> until);
    void draw(const PacingDecision& decision);
    void draw_snapshot();
    void promise(std::int64_t frame, int still_samples);
    void measure(const FrameSent& sent, base::Clock::time_point asked);

    // --- what draws, and what fails in it
    Painted paint(const View& view, Image& image, FrameStats& stats,
                  const std::function<bool()>& interrupted = {}, Accumulation* kept = nullptr);
    void renew_painter(std::string why);
    std::optional<std::string> take(const scene::LoadedScene& scene);
    void show(const scene::SceneLoaded& loaded);
    struct Undrawable {
        View visible;
        protocol::Resize view_size;
    };
    void draw_smaller(const Undrawable& what, const PictureSize& size, const std::string& why);
    bool is_undrawable() const;
    void refuse(const Snapshot& snapshot, const std::string& sentence);
    /// Tells all clients; the log, too.
    void notice(const std::string& sentence);
    void use(const protocol::LevelTable& table);
    void was_delivered(std::int64_t frame);
    protocol::Quality quality_at_rest(int samples) const;
    std::size_t choose_level();
    bool knows_link() const;
    void note(const Begun& begun);

    void begin(const scene::LoadedScene& scene);
    scene::LoadedScene with_notices(scene::LoadedScene scene) const;

    scene::SceneLibrary library_;
    std::filesystem::path record_folder_;
    observe::Metrics& metrics_;
    EngineCallbacks callbacks_;
    PictureLimits limits_;
    std::string description_;
    const base::Clock::time_point start_ = base::Clock::now();
    Mailbox mailbox_;
    const std::shared_ptr<ResultPost> file_results_;
    SceneLookup lookup_;
    RecordingWriter recordings_;
    std::map<std::string, std::deque<EngineEvent>> waiting_;  ///< by client; "": of none
    std::atomic<std::size_t> taken_{0};                       ///< events in waiting_
    base::Heartbeat heart_;
    std::atomic<bool> draws_{false};
    std::string last_handled_;
    Encoder encoder_, snapshot_encoder_;
    scene::SceneLoader loader_;
    PainterFactory factory_;
    Painter painter_;
    std::size_t tries_ = 0;                      ///< painters made since the last whole picture
    std::optional<scene::SceneLoaded> arrived_;  ///< to be shown as soon as nothing is being drawn
    PictureLimits room_;                         ///< of the live picture, as far as is known
    protocol::Resize room_for_;                  ///< of a view of this size
    std::optional<Undrawable> undrawable_;       ///< for which there is no memory even if it is small

    std::optional<room::Presentation> presentation_;
    std::map<std::string, Client> clients_;
    std::deque<Snapshot> snapshots_;         ///< in the order of asking; the first may have been begun
    base::Clock::time_point snapshot_turn_;  ///< while things move: not before
    EngineOutput output_;
    std::shared_ptr<const protocol::StateDocument> reported_;  ///< the newest document that output told of
    PictureSize reported_size_;
    observe::LiveStats stats_;

    base::Clock::time_point last_change_;                  ///< of what is to be seen; long ago at the start
    std::optional<base::Clock::time_point> newest_input_;  ///< arrival of the last message that changed it
    base::Clock::time_point measured_input_{};             ///< the newest whose way to a grant was measured
    struct Drawn {
        std::int64_t frame = 0;
        View visible;
        protocol::Resize view_size;
        int still_samples = 0;  ///< 0: a moving one
    } drawn_;
    std::int64_t next_frame_ = 1;
    std::int64_t present_since_ = 1;  ///< the first frame of the view as it is
    std::deque<Begun> begun_;         ///< the last moving frames
    std::string measured_by_;         ///< the client to whom the last of them that was measured went
    std::optional<LevelChoice> choice_;
    std::vector<protocol::Level> at_rest_;        ///< of the table
    std::shared_ptr<const DetailLevels> detail_;  ///< null until the scene's first picture was delivered
    std::future<void> given_up_;                  ///< of the scenes before
    std::int64_t scene_since_ = 1;                ///< first frame of the scene shown

    std::thread thread_;  // last: it uses all of the above
};

}  // namespace vrut::server::engine
