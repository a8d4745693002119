#include "net/bodies_sent.hpp"

#include <utility>

namespace vrut::server::net {

struct BodiesSent::Entry {
    BodiesSent& all;
    Body body;
    std::function<void()> cut;
    std::list<Entry*>::iterator place{};
    bool counts = true;

    ~Entry() {
        if (counts) all.remove(*this);
    }
};

BodiesSent::Sending BodiesSent::add(const Body& body, std::function<void()> cut) {
    const std::shared_ptr<Entry> entry(new Entry{*this, body, std::move(cut)});
    if (senders_[body]++ == 0) bytes_ += body->size();
    entry->place = entries_.insert(entries_.end(), entry.get());
    while (bytes_ > most_ && entries_.size() > 1) {
        Entry& oldest = *entries_.front();
        remove(oldest);
        std::exchange(oldest.cut, {})();  // which may end it
    }
    return entry;
}

void BodiesSent::remove(Entry& entry) {
    entry.counts = false;
    entries_.erase(entry.place);
    const auto senders = senders_.find(entry.body);
    if (--senders->second > 0) return;
    bytes_ -= entry.body->size();
    senders_.erase(senders);
}

}  // namespace vrut::server::net
