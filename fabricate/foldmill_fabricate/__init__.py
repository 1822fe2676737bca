"""From a fold to a finished sheet: plan, write, verify, drive."""
