#include <cstdint>
#include <cstdlib>
#include <sstream>

#include "io/vrut/text_reader.hpp"
#include "io/vrut/text_writer.hpp"
#include "io/vrut/tokenizer.hpp"

using namespace vrut;

namespace {

vrut::io::ReadResult read(std::string_view text) { return vrut::io::read_vrut_text(text, "fuzz.vrut"); }

std::string written(const vrut::io::ReadResult& scene) {
    if (!scene) return scene.error();
    std::ostringstream out;
    vrut::io::write_vrut_text(*scene, out);
    return out.str();
}

void check(bool holds) {
    if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    auto scene = read(text);
    const std::string once = written(scene);
    if (scene) check(written(read(once)) == once);
    if (size % 16 == 0 && size < vrut::io::kChunkBytes) {
        // The same where the second chunk begins in the middle of it.
        const std::string space(vrut::io::kChunkBytes - size / 2, ' ');
        check(written(read(space + std::string(text))) == once);
    }
    if (scene) vrut::scene::place(*std::move(scene));
    return 0;
}
