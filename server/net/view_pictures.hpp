#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "engine/frame_quality.hpp"
#include "engine/picture.hpp"
#include "engine/room_engine.hpp"

namespace vrut::server::net {

/// What a picture of the view depends on.
struct ViewPictureKey {
    std::int64_t revision = 0;       ///< of the state
    engine::PictureSize size, view;  ///< the view's own, which its header names
    bool operator==(const ViewPictureKey&) const = default;
};

/// A JPEG file of the view.
struct ViewPicture {
    ViewPictureKey key;
    std::shared_ptr<const std::string> file;
};

/// Pictures of the view for those who are no clients, on the net thread. Those who ask for the same wait for
/// one drawing, and what was drawn is kept while nothing changes.
class ViewPictures {
public:
    using Done = std::function<void(const ViewPicture*)>;  ///< null: it cannot be drawn
    static constexpr std::size_t kMostWaiting = 8;         ///< drawings
    static constexpr std::size_t kMostKept = 4, kMostKeptBytes = std::size_t{16} << 20;

    /// The entity tag; it differs in every run of the server.
    std::string tag(const ViewPictureKey& key) const;
    /// Null if it is not kept.
    const ViewPicture* find(const ViewPictureKey& key) const;
    /// Asks the engine for an image of this revision or a newer one, and calls `done` with it. False if
    /// kMostWaiting are being drawn. `suffix`: of its name there.
    bool ask(const ViewPictureKey& key, Done done, engine::RoomEngine& engine, const std::string& suffix);
    /// A JPEG file without a header; null: it cannot be drawn.
    using Drawn = std::function<void(std::shared_ptr<const std::string>)>;
    /// Asks for an image of another view, which is not kept. Who calls this bounds how many are being drawn.
    void draw(const protocol::OtherView& view, engine::PictureSize size, Drawn done,
              engine::RoomEngine& engine, const std::string& suffix);
    /// False where `picture` is none that was asked for here.
    bool take(const engine::EncodedPicture& picture);
    /// The picture that was asked for by this name cannot be drawn.
    void give_up(const std::string& name);
    void forget_before(std::int64_t revision);
    /// Forgets those who wait.
    void stop() {
        waiting_.clear();
        others_.clear();
    }

private:
    struct Drawing {
        ViewPictureKey key;  ///< when it was asked for
        std::vector<Done> waiting;
    };
    void keep(const ViewPicture& picture);

    std::string run_ = std::to_string(std::random_device{}());
    std::map<std::string, Drawing> waiting_;  ///< by the picture's `client`
    std::map<std::string, Drawn> others_;     ///< likewise, of other views
    std::int64_t next_ = 1;
    std::vector<ViewPicture> kept_;  ///< oldest first
};

}  // namespace vrut::server::net
