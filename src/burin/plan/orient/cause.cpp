// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/cause.h"

namespace burin::orient {

const char* word(Cause cause) {
  switch (cause) {
    case Cause::none:
      return "none";
    case Cause::gouge:
      return "gouge";
    case Cause::collision:
      return "collision";
    case Cause::limit:
      return "limit";
    case Cause::bound:
      return "bound";
  }
  return "none";
}

}  // namespace burin::orient
