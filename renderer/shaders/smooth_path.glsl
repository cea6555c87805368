// Of a ray that may have come by way of mirrors or through glass, see passes/smooth_paths.comp: how often its light has
// bounced when it leaves what the ray hits, and whether it has lost a choice there. Both lie in the ray's reach.

const float kFarReach = 1e30;
const float kNoOtherStrategy = 1e30;  // as a density: it outweighs any other

uint path_code(uint bounces, bool dropped) { return 2u * bounces + (dropped ? 1u : 0u); }
float reach_of(uint code) { return kFarReach * float(1u + code); }
uint code_of(float reach) { return uint(max(reach / kFarReach - 0.5, 0.0)); }
uint bounces_of(float reach) { return code_of(reach) / 2u; }

// What the hit mirrors has been left to other rays (MIRRORS_ALONE: but for the lamps).
bool is_mirror_dropped(float reach) { return (code_of(reach) & 1u) != 0u; }
