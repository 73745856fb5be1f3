#include "bake/pipeline/layer_costs.h"

#include <algorithm>
#include <string_view>

#include "bake/layers/layer_error.h"
#include "bake/layers/layer_work.h"
#include "bake/layers/plan_layers.h"

namespace opaline::bake {
namespace {

PlanEntry* find_layer_entry(std::span<PlanEntry> plan, std::uint32_t layer, std::string_view name) {
    const auto found = std::ranges::find_if(plan, [&](const PlanEntry& entry) {
        return entry.subject.kind == Subject::Kind::layer && entry.subject.index == layer &&
               entry.name == name;
    });
    return found == plan.end() ? nullptr : &*found;
}

}  // namespace

void bill_layers(const CostRequest& request, std::span<PlanEntry> plan, Bill& bill) {
    for (std::uint32_t i = 0; i < request.scene.layers.size(); ++i) {
        PlanEntry* const cloud = find_layer_entry(plan, i, kCloud);
        PlanEntry* const often = find_layer_entry(plan, i, kCloudOften);
        if (cloud != nullptr && !cloud->on) {
            continue;
        }
        const formats::CloudLayer& layer = request.scene.layers[i];
        const LayerWork once = count_layer_work(layer, {i, true, false, false}, request.knobs);
        const bool has_often = often == nullptr || often->on;
        const LayerWork all = count_layer_work(layer, {i, true, has_often, false}, request.knobs);
        bill.open("droplets of clouds");
        bill.add(droplet_work(once), cloud);
        bill.open("tables of clouds");
        bill.add(table_work(once), cloud);
        bill.add(table_work(all) - table_work(once), often);
        bill.add_bytes(once.bytes, cloud);
        bill.add_bytes(all.bytes - once.bytes, often);
        bill.open("self-check of clouds");
        bill.add({0, check_products() * kRadianceProduct});
    }
}

}  // namespace opaline::bake
