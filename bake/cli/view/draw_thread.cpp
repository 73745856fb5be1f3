#include "bake/cli/view/draw_thread.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "bake/cli/messages.h"
#include "bake/environment/builtin_environment.h"

namespace opaline::cli {
namespace {

constexpr std::uint32_t kFinalSamples = 3;  // along a pixel's side, as `render`
constexpr double kQuick = 0.04;             // seconds of a picture in motion
constexpr std::chrono::milliseconds kRest{120};

// A file that is open, and which reading of which path it is.
struct OpenFile {
    std::string path;
    std::uint64_t version = 0;
    std::optional<ShownFile> shown;
};

// Opens it unless it is. Where that fails, what was open stays, and is tried again the next time.
formats::Status keep_open(OpenFile& file, const std::string& path, std::uint64_t version) {
    if (path.empty()) {
        file = {};
        return formats::ok_status();
    }
    if (file.shown && file.path == path && file.version == version) return formats::ok_status();
    auto opened = ShownFile::open(path);
    if (!opened) return opened.error();
    file.path = path;
    file.version = version;
    file.shown.emplace(std::move(*opened));
    return formats::ok_status();
}

// Smaller and with fewer samples, so that it takes about kQuick.
struct Quality {
    std::uint32_t divisor = 1, supersampling = kFinalSamples;

    double samples(const ViewState& state) const {
        const double pixels = static_cast<double>(state.width) * state.height;
        return pixels * supersampling * supersampling / (divisor * divisor);
    }
};

Quality quick_quality(const ViewState& state, double seconds_per_sample) {
    for (const Quality quality : {Quality{1, kFinalSamples}, Quality{1, 1}, Quality{2, 1}}) {
        if (quality.samples(state) * seconds_per_sample <= kQuick) return quality;
    }
    return {4, 1};
}

struct DrawWork {
    OpenFile file, other;
    std::string light;
    std::uint64_t light_request = 0, light_version = 0;
    std::optional<formats::Environment> environment;
    double seconds_per_sample = 1e-7;  // of the last picture

    formats::Status open_all(const DrawRequest& request);
    formats::Result<DrawnView> draw(const DrawRequest& request, const Quality& quality);
    formats::Result<DrawnSide> draw_side(OpenFile& from, const ViewState& state,
                                         const runtime::Camera& camera, std::uint32_t samples);
};

formats::Status DrawWork::open_all(const DrawRequest& request) {
    if (auto status = keep_open(file, request.state.file, request.file_version); !status) {
        return status;
    }
    if (auto status = keep_open(other, request.state.other, request.other_version); !status) {
        return status;
    }
    if (environment && light == request.state.light && light_request == request.light_version) {
        return formats::ok_status();
    }
    auto opened = bake::open_environment(request.state.light);
    if (!opened) return opened.error();
    if (auto status = report_warnings(opened->warnings); !status) return status;
    environment = std::move(opened->environment);
    light = request.state.light;
    light_request = request.light_version;
    ++light_version;
    return formats::ok_status();
}

formats::Result<DrawnSide> DrawWork::draw_side(OpenFile& from, const ViewState& state,
                                               const runtime::Camera& camera,
                                               std::uint32_t samples) {
    DrawnSide side;
    if (!from.shown) return side;
    ShownFile& shown = *from.shown;
    if (auto status = shown.follow(state, *environment, light_version); !status) {
        return status.error();
    }
    auto picture = shown.draw(camera, samples);
    if (!picture) return picture.error();
    side.picture = std::move(*picture);
    side.facts = shown.facts();
    side.seconds = shown.seconds();
    side.coefficient_error = shown.coefficient_error();
    return side;
}

formats::Result<DrawnView> DrawWork::draw(const DrawRequest& request, const Quality& quality) {
    const ViewState& state = request.state;
    const Viewpoint from = state.viewpoint ? *state.viewpoint : file.shown->framing(state);
    runtime::Camera camera = camera_of(state, from);
    camera.width = std::max(1u, camera.width / quality.divisor);
    camera.height = std::max(1u, camera.height / quality.divisor);
    DrawnView view;
    view.viewpoint = from;
    view.is_final = quality.divisor == 1 && quality.supersampling == kFinalSamples;
    auto first = draw_side(file, state, camera, quality.supersampling);
    if (!first) return first.error();
    view.file = std::move(*first);
    auto second = draw_side(other, state, camera, quality.supersampling);
    if (!second) return second.error();
    view.other = std::move(*second);
    const double seconds = view.file.seconds.draw + view.file.seconds.readback +
                           view.other.seconds.draw + view.other.seconds.readback;
    seconds_per_sample = seconds / quality.samples(state);
    return view;
}

}  // namespace

DrawThread::DrawThread() : thread_([this] { run(); }) {}

DrawThread::~DrawThread() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

void DrawThread::request(DrawRequest request) {
    {
        const std::lock_guard lock(mutex_);
        request_ = std::move(request);
    }
    wake_.notify_all();
}

std::shared_ptr<const DrawnView> DrawThread::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(drawn_, nullptr);
}

void DrawThread::run() {
    DrawWork work;
    const auto draw = [&](const DrawRequest& request, bool is_quick) {
        auto drawn = std::make_shared<DrawnView>();
        try {
            formats::Status opened = work.open_all(request);
            auto view =
                opened ? work.draw(request,
                                   is_quick ? quick_quality(request.state, work.seconds_per_sample)
                                            : Quality{})
                       : formats::Result<DrawnView>(opened.error());
            if (view) {
                *drawn = std::move(*view);
            } else {
                drawn->error = view.error();
            }
        } catch (const std::exception& fault) {
            drawn->error = formats::make_error(formats::ErrorKind::resource, "", "drawing",
                                               fault.what(), "close other programs");
        }
        drawn->serial = request.serial;
        drawn->is_final |= drawn->error.has_value();
        const bool is_final = drawn->is_final;
        const std::lock_guard lock(mutex_);
        drawn_ = std::move(drawn);
        return is_final;
    };
    for (;;) {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [this] { return ends_ || request_; });
        if (ends_) return;
        const DrawRequest request = *std::exchange(request_, std::nullopt);
        lock.unlock();
        if (draw(request, true)) continue;
        lock.lock();
        if (wake_.wait_for(lock, kRest, [this] { return ends_ || request_; })) continue;
        lock.unlock();
        draw(request, false);
    }
}

}  // namespace opaline::cli
