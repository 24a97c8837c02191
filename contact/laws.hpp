#pragma once

#include "butee/model/types.hpp"

namespace butee::contact {

model::LawType arctan_type();
model::LawType linear_type();
model::LawType hertz_type();

model::ContactType ring_type();
model::ContactType plane_type();

}  // namespace butee::contact
