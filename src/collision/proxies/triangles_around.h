// Vertex-triangle incidence, which untangling uses to find neighbourhoods.
#pragma once

#include "collision/proxies/contact_elements.h"

namespace pliant {

/// The triangles incident to each vertex, ascending.
IntLists triangles_around(const ContactElements& elements);

}  // namespace pliant
