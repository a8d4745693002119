#include "net/document_updates.hpp"

namespace vrut::server::net {

namespace {

constexpr std::size_t kSmall = std::size_t{1} << 20;  // bytes

}  // namespace

Text held_text(std::string text, observe::Metrics& metrics) {
    Text counted(new std::string(std::move(text)), [&metrics](const std::string* held) {
        metrics.bytes_held -= held->capacity();
        delete held;
    });
    metrics.bytes_held += counted->capacity();
    return counted;
}

void DocumentUpdates::set(std::shared_ptr<const protocol::StateDocument> document, std::string by,
                          std::int64_t by_since) {
    newest_ = std::move(document);
    by_ = std::move(by);
    by_since_ = by_since;
    updates_.clear();
    small_updates_.clear();
}

Text DocumentUpdates::update_from(const protocol::StateDocument* known, observe::Metrics& metrics) {
    const std::int64_t revision = known ? known->revision() : 0;
    std::weak_ptr<const std::string>& update = updates_[revision];
    if (Text encoded = update.lock()) return encoded;
    Text encoded = held_text(encode_from(known), metrics);
    update = encoded;
    if (encoded->size() <= kSmall) small_updates_[revision] = encoded;
    return encoded;
}

std::string DocumentUpdates::encode_from(const protocol::StateDocument* known) const {
    if (!known || !newest_->has_scene_of(*known)) return newest_->encode();
    const bool one_author = known->revision() + 1 >= by_since_;
    return newest_->encode_patch_from(*known, one_author ? by_ : "");
}

}  // namespace vrut::server::net
