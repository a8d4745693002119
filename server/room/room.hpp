#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec.hpp"
#include "cue_list.hpp"
#include "event_log.hpp"
#include "frame_header.hpp"
#include "mesh/picking.hpp"
#include "mesh/watertight_memo.hpp"
#include "message_table.hpp"
#include "navigation/clicks.hpp"
#include "navigation/flight.hpp"
#include "navigation/gestures.hpp"
#include "plan/view.hpp"
#include "room/answers.hpp"
#include "room/clients.hpp"
#include "room/measures.hpp"
#include "room/pointings.hpp"
#include "room/recordings.hpp"
#include "room/revisions.hpp"
#include "room/scene_state.hpp"
#include "room/seen_frames.hpp"
#include "room/steering.hpp"
#include "room/swings.hpp"
#include "room/walls_camera.hpp"
#include "scenes/loaded_scene.hpp"
#include "state.hpp"
#include "state_document.hpp"

namespace vrut::server::room {

/// How a room takes what is said.
struct Policy {
    /// By rights, by who holds control and by revisions; else it was accepted elsewhere.
    bool judges;
    /// Who holds control is as a log says, and names are; else by the room's own rules.
    bool by_log;
};
inline constexpr Policy kLive{true, false};
/// A recorded session: control passes on as the log says, and who steers takes it.
inline constexpr Policy kReplay{false, true};
/// The same messages come as to a room that another server draws, and control passes on as it does there.
inline constexpr Policy kFollow{false, false};

struct RoomOptions {
    std::optional<RecordingSink> recordings = {};  ///< none: nothing is recorded
    /// Begins to load a scene; Room::load_answered() reports whether it has begun.
    std::function<void(std::int64_t request, const protocol::Open& asked)> load = {};
    /// Looks up the scenes that can be loaded; Room::scenes_listed() takes them.
    std::function<void(std::int64_t request)> scenes = {};
    ShareAddress share = {};  ///< none: nowhere
    /// Takes each line of the log of all that happens here, with times of the session.
    std::function<void(protocol::LogLine line)> journal = {};
    Policy policy = kLive;
};

/// The scene, the state and the camera that all clients share, who steers them, and what each message does to
/// them. No thread, no clock, no GL: the same messages at the same times, in the same order, lead to the same
/// camera to the last bit.
class Room {
public:
    explicit Room(scenes::LoadedScene scene, RoomOptions options = {});

    // What happens. Times never fall: an earlier one counts as the latest before.
    /// `name`: as the client calls itself; empty: it does not. `resume_key`: see Steering::join.
    void join(const std::string& client, protocol::Role role, SessionTime at, const std::string& name = {},
              const std::string& resume_key = {});
    void leave(const std::string& client, SessionTime at);
    /// Any message but `hello` and `frame`. Some are answered later, when a disk has answered. What is
    /// rejected changes nothing, and not who steers either; then false comes back.
    bool handle_message(const std::string& client, const protocol::ClientMessage& message, SessionTime at);
    /// What moves goes on to where it is then; control passes on from who has been gone too long.
    void advance(SessionTime at);
    /// When advance() has to be called at the latest, but while something moves; none: never.
    std::optional<SessionTime> deadline() const;
    /// For replays: `client` holds control from then on; empty: nobody.
    void pass_control(const std::string& client, SessionTime at);
    /// Shows another scene from here on; control, navigation, drawing mode and quality stay.
    void show(scenes::LoadedScene scene, SessionTime at);
    /// Tells all clients what has gone wrong in the server, until newer notices take its place.
    void notice(const protocol::Notice& notice);
    /// Loading has begun, or why not; once for each call of RoomOptions::load.
    void load_answered(std::int64_t request, const std::optional<protocol::Error>& rejection, SessionTime at);
    /// Once for each call of RoomOptions::scenes.
    void scenes_listed(std::int64_t request, std::vector<std::string> names);
    /// Its file is open under this name, or cannot be opened, a sentence; once for each that began.
    void recording_opened(std::int64_t recording, const tl::expected<std::string, std::string>& name,
                          SessionTime at);
    /// Its last line is written, or it has ended before that: why, in words that end a sentence. Once for
    /// each that was opened.
    void recording_ended(std::int64_t recording, const std::optional<std::string>& why, SessionTime at);
    /// A frame has been drawn of visible() at view_size(): picks name it.
    void remember(std::int64_t frame);
    /// To be called first, if at all: as things stood when a recording began.
    tl::expected<void, protocol::Error> restore(const protocol::LogHeader& header);
    /// As things stand now, for restore() and, behind it, follow(); none while something goes on that they do
    /// not hold.
    std::optional<Checkpoint> checkpoint();
    /// A line for the journal, where the state has a revision that it does not name yet.
    void write_revision();
    /// Where it follows: the state has this revision now.
    void follow(const protocol::LogLine::Revised& revised, SessionTime at);
    /// It follows no longer: from here on messages are judged.
    void go_on(RoomOptions options);
    SessionTime time() const { return time_; }
    std::vector<std::pair<std::string, protocol::Role>> clients() const;

    const scene::PlacedScene& scene() const { return *scene_; }
    const protocol::State& state() const { return state_; }
    /// CSS size of the view.
    const protocol::Resize& view_size() const { return view_size_; }
    /// What is to be seen, but for size and samples.
    const plan::View& visible() const { return visible_; }
    bool flies() const { return flight_.has_value(); }
    /// The camera flies, or something turns about its hinge.
    bool moves() const { return flies() || !swings_.empty(); }
    const std::optional<std::string>& holder() const { return steering_.holder(); }
    /// As others see it: with a number where another client has the same name. Empty where it has none.
    const std::string& client_name(const std::string& client) const;
    const std::string& scene_name() const { return loaded_.name; }
    /// What clients have changed of the scene, to be kept: LoadedScene::changes of its next opening; and by
    /// what name.
    std::string changes() const;
    std::string changes_key() const { return loaded_.changes_key(); }
    /// What was kept of the scene, if it cannot be used: an empty text if it cannot even be read.
    std::optional<std::string> unusable_changes() const;

    /// The document of the present state. Changes since the last call become one revision, made by
    /// `changed_by`.
    const std::shared_ptr<const protocol::StateDocument>& document();
    /// Who made the newest revision and those before it, down to `changed_by_since()`; empty: the server.
    const std::string& changed_by() const { return revisions_.changed_by(); }
    std::int64_t changed_by_since() const { return revisions_.changed_by_since(); }

    /// Answers what a client said that cannot be read.
    void reject(const std::string& client, const protocol::Error& error);
    std::vector<Answer> take_answers() { return std::exchange(answers_, {}); }
    std::vector<PictureOrder> take_orders() { return std::exchange(orders_, {}); }
    /// What is to be sent to all clients: the newest of each that points, or has pointed.
    std::vector<protocol::Pointed> take_pointed() { return pointings_.take(); }
    /// What of a list of cues does not go with the scene: `list` is as in its file.
    protocol::Checked check_cues(const nlohmann::json& list) const;
    /// The same of the file's text.
    protocol::Checked check_cues(const std::string& text) const;
    /// What is to be seen in another size, for whoever is no client: the present view, or one laid over it,
    /// or what is wrong with that.
    tl::expected<PictureOrder, protocol::Error> order(int width, int height,
                                                      const protocol::OtherView& other = {});

private:
    /// The message in hand.
    struct Received {
        const std::string& client;
        const protocol::ClientMessage& message;
        protocol::MessageTraits traits = protocol::traits_of(message);
        /// Of a finger or a key: it is no error worth an answer each.
        bool is_input() const { return traits.weight == protocol::Weight::stream && !message.id; }
    };
    struct InFlight {
        navigation::CameraPath path;
        std::string client;
        std::int64_t id = 0;  ///< 0: none
        SessionTime start{0};
        protocol::CameraState from;
        protocol::Fly asked;
    };

    void apply(const Received& received, const protocol::Hello& hello);
    void apply(const Received& received, const protocol::FrameGrant& grant);
    void apply(const Received& received, const protocol::Resize& resize);
    void apply(const Received& received, const protocol::Pointer& pointer);
    void apply(const Received& received, const protocol::Wheel& wheel);
    void apply(const Received& received, const protocol::Key& key);
    void apply(const Received& received, const protocol::Navigate& navigate);
    void apply(const Received& received, const protocol::Fit& fit);
    void apply(const Received& received, const protocol::Swing& swing);
    void apply(const Received& received, const protocol::Patch& patch);
    void apply(const Received& received, const protocol::Pick& pick);
    void apply(const Received& received, const protocol::Snapshot& snapshot);
    void apply(const Received& received, const protocol::Fly& fly);
    void apply(const Received& received, const protocol::Cue& cue);
    void apply(const Received& received, const protocol::Check& check);
    void apply(const Received& received, const protocol::Tree& tree);
    void apply(const Received& received, const protocol::Open& open);
    void apply(const Received& received, const protocol::Scenes& scenes);
    void apply(const Received& received, const protocol::Record& record);
    void apply(const Received& received, const protocol::Control& control);
    void apply(const Received& received, const protocol::Shown& shown);
    void apply(const Received& received, const protocol::Share& share);
    void apply(const Received& received, const protocol::Point& point);

    /// A state and the scene as they would stand.
    struct Laid {
        protocol::State state;
        std::shared_ptr<const scene::PlacedScene> placed;
    };
    /// With a cue and a camera laid over what is shown.
    tl::expected<Laid, protocol::Error> laid(const protocol::OtherView& other);
    /// As use_nodes(). Pictures of the same nodes have one scene as long as they wait.
    std::optional<protocol::Error> use_laid_nodes(protocol::State& next,
                                                  std::shared_ptr<const scene::PlacedScene>& placed);
    plan::View view_of_laid(const Laid& laid) const;

    /// Does what a message does; whether it was accepted.
    template <class Apply>
    bool handle(const Received& received, SessionTime at, Apply apply);
    /// Makes the view of the present state. Its marks stay the same while neither they nor the scene change.
    void update_visible();
    /// Remembers a message that is answered later: the number by which.
    std::int64_t answer_later(const Received& received);
    /// That message; none where its client has left.
    std::optional<AnsweredLater> take_request(std::int64_t request);
    bool is_here(const AnsweredLater& asked) const { return clients_.contains(asked.client); }

    /// Done; `ok` where the message has an id.
    void answer(const Received& received, std::optional<std::string> name = {});
    /// Done, with an answer of its own.
    template <class Message>
    void answer_with(const Received& received, Message message) {
        accepted_ = true;
        if (!received.message.id) return;
        message.id = *received.message.id;
        answers_.push_back({received.client, protocol::encode(message), document()->revision()});
    }
    void reject(const Received& received, const char* code, const std::string& sentence);

    // --- who steers
    /// Returns true if its client's role is one of these; else it is rejected.
    bool may_send(const Received& received, protocol::Right right);
    /// Returns true if this message may steer; else it is rejected.
    bool may_steer(const Received& received);
    void reject_not_in_control(const Received& received);
    /// advance() without steps of the walls between.
    void advance_to(SessionTime at);
    /// The message steers. In a replay its client holds control: in logs of before, who steered took it.
    void steer(const Received& received);
    /// Brings the state in line with who holds control now.
    void show_holder();
    /// A line for the log, where who holds control has changed since the last one.
    void record_holder();
    void use_holders_size();

    // --- pointing at things
    SeenFrame present() const { return {0, camera(), view_size_}; }
    /// The one that a message names, or the present view; none where it is not remembered: the message is
    /// rejected.
    std::optional<SeenFrame> frame_named(const Received& received, const std::optional<std::int64_t>& number);
    /// What of the present scene lies along a ray.
    std::optional<mesh::Hit> hit_along(const mesh::Ray& ray, bool through) const;
    void apply(navigation::Click::Operation operation, const std::optional<mesh::Hit>& hit);
    void select(scene::Index node);
    /// kNone where nothing is.
    scene::Index selected() const;
    /// From the root, the last 32.
    struct Path {
        std::vector<std::string> names;
        std::vector<scene::Id> ids;
    };
    Path path_of(scene::Index node) const;

    // --- pointing others to things
    bool may_point(const std::string& client) const;
    void send_pointings();
    /// Who may point has changed.
    void use_pointing();

    // --- the camera of hosts, which follows the room's at the speeds of `comfort`
    /// Begins or ends what follows, in line with who is here, and with what moves.
    void use_walls();
    void restore_clients(const std::vector<protocol::LogHeader::Client>& clients);
    /// Its next step, at time_.
    void step_walls();

    // --- measures
    /// Brings what is measured in line with the measures and the scene.
    void measure();

    // --- hinges
    void advance_swings();
    void end_swings();

    // --- patches
    /// Lays what is kept of the scene over what its file says. Where it cannot be used, nothing of it counts,
    /// and a notice says so.
    void lay_changes();
    std::optional<protocol::Error> use_changes();
    std::optional<protocol::Error> use_nodes(protocol::State& next,
                                             std::shared_ptr<const scene::PlacedScene>& placed);
    std::optional<protocol::Error> use_camera(protocol::State& next, const scene::PlacedScene& placed,
                                              const protocol::NamedCameraMembers& named);
    /// Brings views, markers, measures and cues in line with the scene, or what is wrong with them.
    std::optional<protocol::Error> use_entries(protocol::State& next, const scene::PlacedScene& placed) const;
    std::optional<protocol::Error> use_views(protocol::State& next, const scene::PlacedScene& placed) const;
    std::optional<protocol::Error> check_names(const protocol::State& next) const;

    // --- notes
    /// Brings the views of changed notes in line with the scene, or what is wrong with them.
    std::optional<protocol::Error> use_notes(protocol::State& next, const scene::PlacedScene& placed) const;

    // --- cues
    /// The name of the cue that a message names; none: the message is rejected.
    std::optional<std::string> cue_named(const Received& received, const protocol::Cue& cue);
    /// Brings changed cues of a patch in line with the scene, or what is wrong with them.
    std::optional<protocol::Error> use_cues(protocol::State& next) const;
    /// What is shown stays that, or its new name, or the one before it.
    void keep_shown_cue(protocol::State& next) const;
    /// What has a hinge goes from where it stands in the cue's `ms` to where it stands in `next`, whose nodes
    /// begin there.
    void swing_to_cue(const protocol::CueState& cue, protocol::State& next);
    protocol::Checked checked(const tl::expected<protocol::ReadCueList, protocol::Error>& list) const;
    void fly_to_cue(const Received& received, const protocol::Fly& fly);

    // --- recordings
    void start_recording(const Received& received, const std::string& name);
    void stop_recording(const Received& received);
    protocol::LogHeader header_of_now() const;
    RecordingSink::Header log_header() const;
    /// In recording and journal.
    void record(const std::string& client, decltype(protocol::LogLine::what) what);
    void press_anew(const std::string& client);

    // --- the camera
    scene::Camera camera() const { return camera_of(state_.camera); }
    double aspect() const { return view_size_.width / view_size_.height; }
    /// What is fitted avoids it.
    navigation::Cover cover() const;
    /// `touched`: what a client sees where it touches; none: what is found there.
    navigation::NavigationContext navigation_context(const std::optional<glm::dvec3>& touched = {}) const;
    /// From a drag: it goes on from where it began.
    void drag_camera(const scene::Camera& camera);
    /// From anything else: drags begin anew there.
    void move_camera(const scene::Camera& camera);
    void fit_selection();
    void end_flight(bool completed);
    void add_notice(const protocol::Notice& notice);

    RoomOptions options_;
    scenes::LoadedScene loaded_;
    std::shared_ptr<const scene::PlacedScene> scene_;  ///< with its nodes as they stand now
    protocol::Resize view_size_;
    protocol::State starting_, state_;
    Revisions revisions_;
    std::vector<Answer> answers_;
    std::vector<PictureOrder> orders_;
    /// As cues have it that pictures are drawn of; gone with the pictures.
    std::vector<
        std::pair<protocol::SharedMap<protocol::NodeOverride>, std::weak_ptr<const scene::PlacedScene>>>
        laid_scenes_;
    Pointings pointings_;
    Clients clients_;
    Steering steering_;
    navigation::Gestures gestures_;
    navigation::Clicks clicks_;
    std::optional<InFlight> flight_;
    Swings swings_;
    WallsCamera walls_;
    SessionTime time_{0};    ///< of what happens now
    bool accepted_ = false;  ///< the message in hand
    /// Who holds control by the lines of a log up to here, and whether that client is absent.
    std::pair<std::optional<std::string>, bool> recorded_holder_;
    /// In a replay: for the press that took control to end. It is measured in the view that it began in.
    bool size_waits_ = false;
    bool at_home_ = false;  ///< nobody has moved the camera since loading: it follows the view's size
    plan::View visible_;
    protocol::SharedMap<protocol::Marker> shown_markers_;  ///< whose marks are in visible_
    mutable mesh::WatertightMemo watertight_;
    Measures measures_;
    SeenFrames frames_;
    AnswersLater requests_;
    Recordings recordings_;
    Journal journal_;
};

}  // namespace vrut::server::room
