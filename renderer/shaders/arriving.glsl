// Light that arrives along a ray times the ray's weight, with the distance it comes from.

const float kNoHit = -1.0;  // the distance of a ray that hit nothing
