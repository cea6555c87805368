// How certain a texel of the indirect map is: the variance of its luminance, as the mean of all its frames. Negative where
// nothing is seen.

const float kUnknownVariance = 1e30;
const float kFewFrames = 4.0;  // fewer say nothing of the variance

// Of the first and second moment over so many frames.
float variance_of_mean(vec2 moments, float frames) {
  const float variance = max(moments.y - moments.x * moments.x, 0.0) / max(frames - 1.0, 1.0);
  return frames < kFewFrames ? kUnknownVariance : variance;
}
