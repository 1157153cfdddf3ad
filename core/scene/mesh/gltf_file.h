// A .gltf or .glb: its document, and the data that follows it.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "scene/mesh/gltf_data.h"

namespace weft::text {

// Opens a document and calls read(document, data); what is refused on the way is a fault, whose place begins with
// `name`. `folder`: where buffers of their own lie.
void read_gltf_file(std::string_view bytes, const std::string& name, const std::string& folder,
                    std::vector<Fault>& faults,
                    const std::function<void(const GltfValue& document, GltfData& data)>& read);

}  // namespace weft::text
