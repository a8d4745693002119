#pragma once

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
#include "engine/change_keeper.hpp"
#include "engine/encoder.hpp"
#include "engine/fair_queue.hpp"
#include "engine/frame_quality.hpp"
#include "engine/frame_renderer.hpp"
#include "engine/level_choice.hpp"
#include "engine/mailbox.hpp"
#include "engine/output.hpp"
#include "engine/recording_writer.hpp"
#include "engine/room_engine.hpp"
#include "engine/scene_lookup.hpp"
#include "engine/scheduler.hpp"
#include "engine/shared_hooks.hpp"
#include "mesh/detail_levels.hpp"
#include "navigation/camera_motion.hpp"
#include "observe/live_stats.hpp"
#include "observe/metrics.hpp"
#include "plan/render_job.hpp"
#include "plan/view.hpp"
#include "room/replay.hpp"
#include "room/room.hpp"
#include "scenes/library.hpp"
#include "scenes/loader.hpp"
#include "state.hpp"
#include "state_document.hpp"

namespace vrut::server::engine {

/// So long after the last line of a shared room's log its state is kept as a whole.
inline constexpr std::chrono::seconds kJournalQuiet{1};

struct EngineOptions {
    scenes::LoadedScene scene;
    scenes::SceneLibrary library;
    std::filesystem::path record_folder;
    ChangeKeeper::Store keep_changes = {};  ///< empty: they are lost with the scene
    room::ShareAddress share = {};
    std::optional<SharedHooks> shared = {};  ///< of a room that servers share
};

/// The render thread: owns the scene, the state and the camera, applies what clients say in the order in
/// which it came, and draws a picture when something changed and somebody waits for it.
class Engine final : public RoomEngine {
public:
    /// Starts the thread; throws what `factory` throws, and where the scene does not fit. The first output
    /// holds the first document.
    Engine(EngineOptions options, FrameRendererFactory factory, observe::Metrics& metrics,
           EngineCallbacks callbacks);
    /// Waits for the end of what is in hand, a second at most for disks.
    ~Engine() override;

    void push(EngineEvent event) override { mailbox_.push(std::move(event)); }
    PictureLimits limits() const override { return limits_; }
    std::string description() const override { return description_; }
    std::optional<std::string> why_unready() const override;
    /// True while another server draws the room. From any thread.
    bool follows() const { return follows_; }
    std::size_t events_waiting() const override { return mailbox_.size() + waiting_.size(); }
    std::vector<std::pair<const char*, base::Clock::duration>> busy_times() const override {
        return {{"render", watchdog_.busy_for()},
                {"encode", encoder_.busy_for()},
                {"snapshot encode", snapshot_encoder_.busy_for()}};
    }
    /// Ends the drawing, the recordings and the loading.
    void stop() override;

private:
    struct Client {
        std::int64_t handled = 0;    ///< highest message id
        std::uint64_t sequence = 0;  ///< of the last message that was handled
        int snapshots = 0;           ///< asked for and not sent yet
        FramesWanted wanted;
        std::int64_t from_frame = 1;  ///< the first begun after its last grant
    };
    /// An interactive frame that was begun, until its cost is known.
    struct FrameInFlight {
        std::int64_t frame = 0;
        std::size_t level = 0;
        double pixels = 0, drawn_ms = 0;
    };
    /// The frame that is being drawn.
    struct FrameUnderWay {
        Picture picture;
        plan::View visible;
        protocol::Resize view_size;
        Refinement refinement = Refinement::none;  ///< none: an interactive one
        std::size_t level = 0;
        plan::RenderJob job;
    };
    /// A scene that was read, or why it was not.
    struct Arrived {
        scenes::SceneLoaded loaded;
        plan::View view = {};  ///< its first
        int losses = 0;        ///< of the context, while it was uploaded
    };
    struct Snapshot {
        room::PictureOrder order;
        std::optional<plan::RenderJob> job = {};  ///< none: not begun
        int losses = 0;                           ///< of the context, while it was drawn
    };
    /// The graphics driver is lost, and started again at a time.
    struct Renewal {
        base::Clock::time_point at;
        std::string why;
    };
    static constexpr int kMostLosses = 2;  // of the context, by one snapshot or scene

    // --- the loop: drain, apply, publish, schedule, one step; one of the upload, too, while a scene is
    // opened
    void run();
    void drain(std::optional<base::Clock::time_point> until);
    void apply();
    void publish();
    ScheduleInput situation(base::Clock::time_point now) const;
    /// Takes the step; until when there is nothing to do then, none: until something happens.
    std::optional<base::Clock::time_point> take_step(const ScheduledStep& step);

    void handle(const ClientJoined& joined);
    void handle(const ClientLeft& left);
    void handle(const MessageReceived& received);
    void handle(const FramesWanted& wanted);
    void handle(const FrameEncoded& encoded);
    void handle(const PictureFailed& failed);
    void handle(const SnapshotSent& sent);
    void handle(const PictureAsked& asked);
    void handle(const scenes::SceneLoading& loading);
    void handle(const scenes::SceneLoaded& loaded);
    void handle(const FileWorkDone& done);
    void handle(const FollowFrom& from);
    void handle(const Follow& what);
    void handle(const TakeOver& take_over);
    room::RoomOptions live_options();
    void keep_checkpoint();
    /// Handles some of what waits: the clients in turn, so that none waits behind another's thousand.
    void handle_waiting();
    void handle_message(const MessageReceived& received, const protocol::ClientMessage& message,
                        Client& client);
    void connect_files(room::RoomOptions& options);
    std::optional<protocol::Error> load(const SceneLookup::Found& found);
    void read_levels(const scenes::LoadedScene& scene);
    std::optional<base::Clock::time_point> files_due() const;
    void check_files();
    bool has_changes_to_keep() const;
    void check_changes();
    void keep_changes();
    void note_kept();
    void set_changes_aside();
    double ms_since_start() const {
        return std::chrono::duration<double, std::milli>(base::Clock::now() - start_).count();
    }
    room::SessionTime time_of(base::Clock::time_point when) const {
        return std::chrono::duration_cast<room::SessionTime>(when - start_);
    }

    // --- pictures
    /// The newest picture drawn shows what is to be seen now.
    bool shows_present() const;
    bool wants_depth() const;
    std::optional<scene::Camera> camera_ahead(std::size_t level, const PictureSize& size) const;
    bool wants_newer(const Client& client) const;
    double refined_bytes() const;
    base::Clock::duration refined_delivery(const std::optional<Link>& link) const;
    std::optional<Link> holders_link() const;
    bool thin_lines() const;
    bool is_outdated(const FrameUnderWay& frame) const;
    void advance_room();
    PictureSize present_size() const;
    void broadcast(const protocol::Loading& loading);
    std::map<std::string, Applied> applied() const;
    void begin_frame(Refinement refinement);
    plan::RenderJob begin_job(plan::View view, Refinement refinement);
    void draw_frame();
    void finish_frame();
    void give_up_frame();
    std::deque<Snapshot>::iterator next_snapshot();
    void draw_snapshot();
    void finish_snapshot(Snapshot snapshot);

    // --- what draws, and what fails in it
    enum class Drawn { part, whole, lost };
    Drawn draw(plan::RenderJob& job);
    void lose_renderer(const std::string& why);
    void renew_renderer();
    void show_arrived();
    void show(const scenes::SceneLoaded& loaded, std::optional<std::string> rejected);
    struct Failed {
        plan::View visible;
        protocol::Resize view_size;
    };
    void draw_smaller(const Failed& what, const PictureSize& size, const std::string& why);
    bool has_failed() const;
    void reject(const Snapshot& snapshot, const std::string& sentence);
    void reject(const std::string& client, std::optional<std::int64_t> id, const std::string& sentence);
    /// Tells all clients; the log, too.
    void notice(const protocol::Notice& notice);
    void use(const protocol::LevelTable& table);
    void make_detail_levels();
    bool has_slow_link() const;
    protocol::Quality refined_quality(Refinement refinement) const;
    std::size_t choose_level();

    void begin(const scenes::LoadedScene& scene);
    scenes::LoadedScene prepared(scenes::LoadedScene scene) const;

    scenes::SceneLibrary library_;
    std::filesystem::path record_folder_;
    room::ShareAddress share_;
    observe::Metrics& metrics_;
    EngineCallbacks callbacks_;
    PictureLimits limits_;
    std::string description_;
    base::Clock::time_point start_ = base::Clock::now();
    const std::optional<SharedHooks> shared_;
    std::atomic<bool> follows_{false};
    std::optional<std::uint64_t> lease_;              ///< of a shared room
    std::uint64_t sequence_ = 0;                      ///< of the message in hand; 0: none
    std::deque<room::Answer> followed_answers_;       ///< the newest
    std::deque<room::PictureOrder> followed_orders_;  ///< likewise
    std::vector<protocol::Notice> held_notices_;      ///< of this server, until it draws the room
    std::size_t lines_ = 0;                           ///< since the last checkpoint
    base::Clock::time_point line_at_;                 ///< the last one
    Mailbox mailbox_;
    const std::shared_ptr<ResultPost> file_results_;
    SceneLookup lookup_;
    RecordingWriter recordings_;
    ChangeKeeper change_keeper_;
    protocol::State kept_;  ///< the last whose changes are kept, or on their way
    FairQueue waiting_;
    base::Watchdog watchdog_;
    std::atomic<bool> draws_{false};
    Encoder encoder_, snapshot_encoder_;
    scenes::SceneLoader loader_;
    FrameRendererFactory factory_;
    FrameRenderer renderer_;
    std::optional<Renewal> renewal_;  ///< while there is no renderer
    std::size_t tries_ = 0;           ///< renderers made since the last whole picture
    std::optional<Arrived> arrived_;  ///< to be shown once it is uploaded
    PictureLimits pixel_budget_;      ///< of the live picture, as far as is known
    protocol::Resize budget_for_;     ///< of a view of this size
    std::optional<Failed> failed_;    ///< what cannot be drawn, even small, or not encoded

    std::optional<room::Room> room_;
    std::map<std::string, Client> clients_;
    Scheduler scheduler_;
    std::optional<FrameUnderWay> frame_;
    std::optional<plan::RenderJob> refining_;  ///< of the newest frame, where the next can go on from it
    std::deque<Snapshot> snapshots_;           ///< in the order of their turns
    EngineOutput output_;
    std::shared_ptr<const protocol::StateDocument> reported_;  ///< the newest document that output named
    PictureSize reported_size_;
    std::int64_t reported_present_ = 0;
    observe::LiveStats stats_;

    base::Clock::time_point last_change_;                  ///< of what is to be seen; long ago at the start
    std::optional<base::Clock::time_point> newest_input_;  ///< arrival of the last message that changed it
    struct NewestFrame {
        std::int64_t frame = 0;
        plan::View visible;
        protocol::Resize view_size;
        Refinement refinement = Refinement::none;  ///< none: an interactive one
        std::int64_t depth_frame = 0;              ///< Picture::depth_frame
    } newest_, before_newest_;
    warp::BlockChoice blocks_;         ///< of maps of depth
    navigation::CameraMotion motion_;  ///< of the camera that is to be seen
    std::deque<std::int64_t> drawn_;   ///< numbers of the last frames
    std::int64_t next_frame_ = 1;
    std::deque<FrameInFlight> in_flight_;  ///< the last interactive ones
    std::optional<LevelChoice> choice_;
    std::vector<protocol::Level> refined_levels_;       ///< of the table
    std::shared_ptr<const mesh::DetailLevels> detail_;  ///< null until the scene's first frame was encoded
    std::int64_t scene_since_ = 1;                      ///< first frame of the scene shown

    const ResultPost::Closing closing_{
        file_results_};   // before any of the above ends, also where making it fails
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace vrut::server::engine
