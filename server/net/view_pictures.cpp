#include "net/view_pictures.hpp"

#include <algorithm>

namespace vrut::server::net {

namespace {

std::string whole_file(const engine::EncodedPicture& picture) {
    const std::vector<std::uint8_t> header =
        picture.header_of_file(picture.header.handled, picture.header.timing.since_input_ms,
                               protocol::EncodedFrameHeader::Depth::none);
    const auto cut = picture.file.begin() + static_cast<std::ptrdiff_t>(picture.header_offset);
    std::string file;
    file.reserve(picture.file.size() + header.size());
    file.append(picture.file.begin(), cut).append(header.begin(), header.end());
    return file.append(cut, picture.file.end());
}

}  // namespace

std::string ViewPictures::tag(const ViewPictureKey& key) const {
    const auto text = [](engine::PictureSize size) {
        return std::to_string(size.width) + "x" + std::to_string(size.height);
    };
    return "\"" + run_ + "-" + std::to_string(key.revision) + "-" + text(key.size) + "-" + text(key.view) +
           "\"";
}

const ViewPicture* ViewPictures::find(const ViewPictureKey& key) const {
    const auto found = std::find_if(kept_.begin(), kept_.end(),
                                    [&](const ViewPicture& picture) { return picture.key == key; });
    return found == kept_.end() ? nullptr : &*found;
}

bool ViewPictures::ask(const ViewPictureKey& key, Done done, engine::RoomEngine& engine,
                       const std::string& suffix) {
    for (auto& [name, drawing] : waiting_)
        if (drawing.key == key) {
            drawing.waiting.push_back(std::move(done));
            return true;
        }
    if (waiting_.size() >= kMostWaiting) return false;
    const std::string name = "picture " + std::to_string(next_++) + suffix;
    waiting_[name] = {key, {std::move(done)}};
    engine.push(engine::PictureAsked{name, key.size.width, key.size.height});
    return true;
}

void ViewPictures::draw(const protocol::OtherView& view, engine::PictureSize size, Drawn done,
                        engine::RoomEngine& engine, const std::string& suffix) {
    const std::string name = "picture " + std::to_string(next_++) + suffix;
    others_[name] = std::move(done);
    engine.push(engine::PictureAsked{name, size.width, size.height, view});
}

bool ViewPictures::take(const engine::EncodedPicture& picture) {
    if (auto other = others_.extract(picture.client)) {
        other.mapped()(std::make_shared<const std::string>(picture.file.begin(), picture.file.end()));
        return true;
    }
    auto drawing = waiting_.extract(picture.client);
    if (!drawing) return false;
    ViewPictureKey key = drawing.mapped().key;
    key.revision = picture.header.revision;
    const ViewPicture taken{key, std::make_shared<const std::string>(whole_file(picture))};
    keep(taken);
    for (const Done& done : drawing.mapped().waiting) done(&taken);
    return true;
}

void ViewPictures::give_up(const std::string& name) {
    if (auto other = others_.extract(name)) return other.mapped()(nullptr);
    const auto drawing = waiting_.extract(name);
    if (!drawing) return;
    for (const Done& done : drawing.mapped().waiting) done(nullptr);
}

void ViewPictures::forget_before(std::int64_t revision) {
    std::erase_if(kept_, [&](const ViewPicture& picture) { return picture.key.revision < revision; });
}

void ViewPictures::keep(const ViewPicture& picture) {
    kept_.push_back(picture);
    const auto bytes = [&] {
        std::size_t sum = 0;
        for (const ViewPicture& each : kept_) sum += each.file->size();
        return sum;
    };
    while (kept_.size() > kMostKept || (!kept_.empty() && bytes() > kMostKeptBytes))
        kept_.erase(kept_.begin());
}

}  // namespace vrut::server::net
