/// Never linked: the size gate reads these objects' sizes from the symbol table.

#include "algo/planner/planner.hpp"

extern "C" {
extern const char s4tp_size_of_planner[sizeof(s4tp::planner::Planner)];
const char s4tp_size_of_planner[sizeof(s4tp::planner::Planner)] = {};
}
