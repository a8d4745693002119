#include <cmath>
#include <iomanip>
#include <iostream>
#include <stdexcept>

#include "base/files.hpp"
#include "commands/commands.hpp"
#include "compare/difference.hpp"
#include "compare/flip.hpp"
#include "engine/images.hpp"
#include "io/image/image_file.hpp"
#include "report.hpp"

namespace vrut::server::commands {

namespace {

scene::Image read(const std::filesystem::path& path) {
    auto image = io::read_image_file(path);
    if (!image) throw std::runtime_error(path.string() + ": " + image.error());
    return *std::move(image);
}

std::string size_of(const scene::Image& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height);
}

protocol::CompareReport report_of(const scene::Image& image, const compare::Difference& difference,
                                  const compare::FlipSummary& flip) {
    protocol::CompareReport report;
    report.width = image.width;
    report.height = image.height;
    report.maximum = difference.maximum();
    report.rms = difference.rms();
    if (std::isfinite(difference.psnr())) report.psnr = difference.psnr();
    report.above2 = difference.share_above(2);
    report.above8 = difference.share_above(8);
    report.flip = {
        flip.mean, flip.weighted_median, flip.first_weighted_quartile, flip.third_weighted_quartile, flip.min,
        flip.max};
    return report;
}

void print(const protocol::CompareReport& report) {
    std::cout << std::fixed << std::setprecision(6)  //
              << "maximum " << report.maximum << " / 255\n"
              << "RMS " << report.rms << " / 255\n"
              << "PSNR ";
    if (report.psnr)
        std::cout << *report.psnr << " dB\n";
    else
        std::cout << "inf dB\n";
    std::cout << "pixels off by more than 2 / 255: " << report.above2 * 100 << " %\n"
              << "pixels off by more than 8 / 255: " << report.above8 * 100 << " %\n"
              << "FLIP mean " << report.flip.mean << ", weighted median " << report.flip.weighted_median
              << ", weighted quartiles " << report.flip.first_weighted_quartile << " and "
              << report.flip.third_weighted_quartile << ", from " << report.flip.min << " to "
              << report.flip.max << std::endl;
}

}  // namespace

void compare_command(const CompareArguments& arguments) {
    if (!arguments.map.empty() && arguments.map.extension() != ".png")
        throw std::runtime_error(arguments.map.string() + ": the name of a map ends in .png");
    const scene::Image a = read(arguments.a), b = read(arguments.b);
    if (a.width != b.width || a.height != b.height)
        throw std::runtime_error("images of different sizes cannot be compared: " + arguments.a.string() +
                                 " is " + size_of(a) + " pixels, " + arguments.b.string() + " is " +
                                 size_of(b));
    const std::vector<float> errors = compare::flip(a, b);
    if (!arguments.map.empty())
        base::write_file(arguments.map, io::encode_png(compare::grey_map(errors, a.width, a.height)));
    const protocol::CompareReport report =
        report_of(a, compare::difference(a, b), compare::summary_of(errors));
    if (arguments.json)
        std::cout << protocol::encode(report) << std::endl;
    else
        print(report);
}

}  // namespace vrut::server::commands
