#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "encoder.hpp"
#include "gestures.hpp"
#include "mailbox.hpp"
#include "metrics.hpp"
#include "pacing.hpp"
#include "scene.hpp"
#include "state.hpp"
#include "steering.hpp"
#include "view.hpp"

namespace vrut {

/// What draws: the renderer, or in a test something that needs no GL. Made, used and destroyed on the render
/// thread.
struct Painter {
    std::string description;
    bool software = false;
    int max_size = 16384;
    /// As Renderer::render.
    std::function<bool(const View&, Image&, FrameStats&, const std::function<bool()>& interrupted)> paint;
};
using PainterFactory = std::function<Painter(std::shared_ptr<const PlacedScene>)>;

/// The renderer as a painter, on EGL device `device` or the first that works.
PainterFactory gl_painter(std::optional<int> device);

/// What the render thread tells the net thread after it has handled a batch of events.
struct EngineOutput {
    struct Answer {
        std::string client, text;
        std::int64_t revision = 0;  ///< the client must know this revision first
    };
    struct Owed {
        std::string client;
        std::int64_t frame = 0;  ///< this frame or a newer one answers one grant
    };
    std::shared_ptr<const protocol::StateDocument> document;  ///< the newest; null if unchanged
    std::string by;                                           ///< who changed it; empty: the server
    std::vector<Answer> answers;
    std::vector<Owed> owed;
    std::map<std::string, std::size_t> handled_bytes;  ///< of messages, for each client

    bool empty() const { return !document && answers.empty() && owed.empty() && handled_bytes.empty(); }
};

struct EngineCallbacks {
    std::function<void(EngineOutput)> on_output;                            ///< on the render thread
    std::function<void(std::shared_ptr<const EncodedPicture>)> on_encoded;  ///< on the encode thread
    std::function<void(const std::string& why)> on_failure;  ///< on either: nothing more will be drawn
};

/// The render thread: owns the scene, the state and the camera, applies what clients say in the order in
/// which it came, and draws a picture when something changed and somebody waits for it.
class Engine {
public:
    /// Starts the thread; throws what `factory` throws. The first output holds the first document.
    Engine(std::shared_ptr<const PlacedScene> scene, const PainterFactory& factory, Metrics& metrics,
           EngineCallbacks callbacks);
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    Mailbox& mailbox() { return mailbox_; }
    const std::string& description() const { return description_; }
    const PictureLimits& limits() const { return limits_; }

private:
    struct Client {
        protocol::Role role = protocol::Role::view;
        std::optional<protocol::Resize> wanted;
        int grants = 0;
        std::int64_t last_frame = 0;  ///< newest that it has been promised
        std::int64_t handled = 0;     ///< highest message id
    };

    // --- events
    void handle(const ClientJoined& joined);
    void handle(const ClientLeft& left);
    void handle(const ClientSaid& said);
    void handle(const GrantsReturned& returned);
    void apply(const std::string& client, const protocol::ClientMessage& message,
               const protocol::Hello& payload);
    void apply(const std::string& client, const protocol::ClientMessage& message,
               const protocol::Resize& payload);
    void apply(const std::string& client, const protocol::ClientMessage& message,
               const protocol::FrameGrant& payload);
    void apply(const std::string& client, const protocol::ClientMessage& message,
               const protocol::Pointer& payload);
    void apply(const std::string& client, const protocol::ClientMessage& message,
               const protocol::Wheel& payload);
    void apply(const std::string& client, const protocol::ClientMessage& message,
               const protocol::Key& payload);
    void apply(const std::string& client, const protocol::ClientMessage& message,
               const protocol::Patch& payload);

    // --- state
    bool may_steer(const std::string& client, const protocol::ClientMessage& message);
    void set_holder_view();
    void set_view(const protocol::Resize& view);
    void move_camera(const Camera& camera);
    NavigationContext navigation_context() const;
    double aspect() const { return view_size_.width / view_size_.height; }
    void commit(const std::string& by);
    void answer(const std::string& client, const protocol::ClientMessage& message);
    void refuse(const std::string& client, const protocol::ClientMessage& message, protocol::Error error);

    // --- pictures
    void note_change();
    /// The newest picture drawn shows what is to be seen now.
    bool shows_present() const;
    bool waits_for_newer(const Client& client) const;
    void serve_newest();
    PacingDecision pace();
    void draw(bool still);

    void run(Painter painter);

    std::shared_ptr<const PlacedScene> scene_;
    Metrics& metrics_;
    EngineCallbacks callbacks_;
    PictureLimits limits_;
    std::string description_;
    Mailbox mailbox_;
    Encoder encoder_;
    Painter painter_;

    protocol::State starting_, state_;
    std::shared_ptr<const protocol::StateDocument> document_;
    protocol::Resize view_size_;
    bool at_home_ =
        false;  ///< nobody has moved the camera since it was fitted at loading: it follows the view's size
    Gestures gestures_;
    Steering steering_;
    std::map<std::string, Client> clients_;
    EngineOutput output_;

    View visible_;                   ///< what is to be seen now
    Clock::time_point last_change_;  ///< of visible_ or the view's size; long ago at the start
    Clock::time_point arrival_;      ///< of the message in hand
    std::optional<Clock::time_point> newest_input_;
    struct Drawn {
        std::int64_t frame = 0;
        View visible;
        protocol::Resize view_size;
        bool still = false;
    } drawn_;

    std::thread thread_;  // last: it uses all of the above
};

}  // namespace vrut
