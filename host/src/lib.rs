//! Host side of Sinew: image folders, skin models, scenes, plots and reports around [`sinew_core`].
