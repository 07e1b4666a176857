#include "polytope.hpp"
