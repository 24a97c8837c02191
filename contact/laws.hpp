#pragma once

#include "butee/model/types.hpp"

namespace butee::contact {

model::LawType arctan_type();
model::LawType linear_type();

}  // namespace butee::contact
