"""Commands on what internal dissipation does to a spin."""
