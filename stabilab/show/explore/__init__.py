"""The explorer: a page with sliders, whose verdict, surface and curves follow while one drags."""
