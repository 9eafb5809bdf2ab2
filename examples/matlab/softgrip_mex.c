/* A function of MATLAB and Octave for a model that `softgrip export` wrote to NAME.c, where NAME begins the names of its
   functions. Compile this file in the same folder:

     mex -DMODEL=NAME -output NAME softgrip_mex.c              in MATLAB
     mkoctfile --mex -DMODEL=NAME -o NAME.mex softgrip_mex.c   in a shell, for Octave

   y = NAME(u)                           displacement at each sample of the command u [kPa]; the finger is at rest under
                                         u(1) at the first sample
   u = NAME(wanted, start, low, high)    command [kPa] that reaches wanted(i) one sample and the dead time after u(i); the
                                         finger is at rest under start [kPa] before, and its pressure stays between low
                                         and high [kPa]

   The samples have the rate of the export (--rate-hz). Displacements have the unit of the model: mm, or degrees. */
#include <math.h>

#include "mex.h"

#define QUOTED(name) #name
#define FILE_OF(name) QUOTED(name.c)
#define JOINED(name, end) name##end
#define OF(name, end) JOINED(name, end)
#define TEXT_OF(name) QUOTED(name)

#include FILE_OF(MODEL)

static size_t samples_of(const mxArray* array, const char* argument) {
  const size_t samples = mxGetNumberOfElements(array);
  size_t i;
  if (!mxIsDouble(array) || mxIsComplex(array) || mxIsSparse(array) || samples == 0 ||
      samples != (mxGetM(array) > mxGetN(array) ? mxGetM(array) : mxGetN(array)))
    mexErrMsgIdAndTxt("softgrip:argument", "%s: a vector of real doubles is required", argument);
  for (i = 0; i < samples; ++i) {
    if (!isfinite(mxGetPr(array)[i]))
      mexErrMsgIdAndTxt("softgrip:argument", "%s: value %lu is not finite", argument, (unsigned long)i + 1);
  }
  return samples;
}

#ifdef HAS_INVERSE
static double number_of(const mxArray* array, const char* argument) {
  if (samples_of(array, argument) != 1)
    mexErrMsgIdAndTxt("softgrip:argument", "%s: 1 number is required", argument);
  return mxGetScalar(array);
}
#endif

void mexFunction(int nlhs, mxArray* plhs[], int nrhs, const mxArray* prhs[]) {
  size_t samples, i;
  double* out;
  if (nlhs > 1 || (nrhs != 1 && nrhs != 4))
    mexErrMsgIdAndTxt("softgrip:call", "the calls are y = %s(u) and u = %s(wanted, start, low, high)",
                      TEXT_OF(MODEL), TEXT_OF(MODEL));
  samples = samples_of(prhs[0], nrhs == 1 ? "u [kPa]" : "wanted");
  if (nrhs == 1) {
    static OF(MODEL, _state) state; /* static: a long delay needs more room than a stack has */
    plhs[0] = mxCreateDoubleMatrix(mxGetM(prhs[0]), mxGetN(prhs[0]), mxREAL);
    out = mxGetPr(plhs[0]);
    out[0] = OF(MODEL, _reset)(&state, mxGetPr(prhs[0])[0]);
    for (i = 1; i < samples; ++i) out[i] = OF(MODEL, _step)(&state, mxGetPr(prhs[0])[i]);
  } else {
#ifdef HAS_INVERSE
    static OF(MODEL, _inverse_state) state;
    const double start = number_of(prhs[1], "start [kPa]");
    const double low = number_of(prhs[2], "low [kPa]");
    const double high = number_of(prhs[3], "high [kPa]");
    if (low >= high) mexErrMsgIdAndTxt("softgrip:argument", "low [kPa]: a value below high is required");
    plhs[0] = mxCreateDoubleMatrix(mxGetM(prhs[0]), mxGetN(prhs[0]), mxREAL);
    out = mxGetPr(plhs[0]);
    OF(MODEL, _inverse_reset)(&state, start);
    for (i = 0; i < samples; ++i) out[i] = OF(MODEL, _inverse_step)(&state, mxGetPr(prhs[0])[i], low, high);
#else
    mexErrMsgIdAndTxt("softgrip:call", "%s.c has no inverse; its first comment states the reason", TEXT_OF(MODEL));
#endif
  }
}
