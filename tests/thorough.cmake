# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0

# Tests with the label "thorough", which scripts/test leaves out and scripts/check.d/13-thorough runs:
# those that cost most and whose code cheaper tests reach too. By program, as filters of GoogleTest.
# Others that run long are labelled where they are added.

# Statistics over many simulated surveys.
set(thorough_ground_test
  Align/HeapThatGrew.EvenlyIsNoShiftOfKnownGround/0
  Align/HeapThatGrew.EvenlyIsNoShiftOfKnownGround/2
  Align/HeapThatGrew.EvenlyIsNoShiftOfKnownGround/3
  Align/HeapThatGrew.EvenlyIsNoShiftOfKnownGround/4
  Align/HeapThatGrew.OnOneSideIsNoShiftOfKnownGround/0
  Align/HeapThatGrew.OnOneSideIsNoShiftOfKnownGround/1
  Align/HeapThatGrew.OnOneSideIsNoShiftOfKnownGround/2
  Align/HeapThatGrew.OnOneSideIsNoShiftOfKnownGround/4
  Align.ItsErrorsAreAsLargeAsItSays
  Align.ScansThatDidNotMoveAreLeftAlone
  SensorPlace.BesideHeapsItIsSeldomWrong
  SensorPlace.ErrorByThePointsIsThatOfRepeatedScansHoweverTheyScatter
  ErrorField.CorrelatedErrorIsThatOfKrigingCellByCellTimesTheFactorForAFittedCovariance
  Align.EdgesOfAHoleOnLevelGroundDoNotPassForAShift
  VolumeChange.CorrelatedNoiseWidensTheInterval
  VolumeChange.HolesInTheScansAreFilledAndWidenTheInterval)
# Errors of a shadow, blocks and accuracy in every case; their means, one case each, stay.
set(thorough_change_test
  Falls/PitInShadow.HasAnErrorThatCoversWhatALedgeHides/*
  Blocks.AreFoundInEveryHeapOfThem
  Blocks.VoidsAreEstimatedWithinTheirStandardDeviation
  Blocks.SizeIsToldToAFifth
  Blocks.LooseSoilIsNeverTakenForThem
  AccuracyOfBulking.IntervalsHoldTheTruthOverRandomDigs
  Scans/AccuracyOfBulking.MeetsItsBarWithinItsInterval/noise
  Scans/AccuracyOfBulking.MeetsItsBarWithinItsInterval/noise20
  Scans/AccuracyOfBulking.MeetsItsBarWithinItsInterval/outliers
  Scans/AccuracyOfBulking.MeetsItsBarWithinItsInterval/tilt
  Scans/AccuracyOfBulking.MeetsItsBarWithinItsInterval/rough
  Scans/AccuracyOfBulking.MeetsItsBarWithinItsInterval/moved
  Scans/AccuracyOfBulking.MeetsItsBarWithinItsInterval/correlated
  Scans/AccuracyOfBulking.MeetsItsBarWithinItsInterval/unseen)
# Six hundred fields, refitted after each dig.
set(thorough_belief_test
  BeliefStatistics.IsNearExactBayesWithWhatIsRefittedAfterEachDig
  BeliefStatistics.ErrsByLessThanTwoAndAHalfPointsOnConstantSoil
  BeliefStatistics.LosesLittleOnOtherFields)
# A simulator of discrete elements in Python.
set(thorough_simulation_test
  CommandSimulator.TheExampleInDiscreteElementsDigs)
# Calibrations and surveys of whole scenes.
set(thorough_sensing_test
  SurveyPlan.PredictsTheScatterOfSimulatedSurveys
  SceneTest.CalibrationDigsInTheSimulatorGiven
  SceneTest.TheUsualLawIsTheShippedOneOfTheVerySameSoil)
# Whole jobs.
set(thorough_job_test
  JobHistory.OfAJobThatWasResumedAfterEachStepIsThatOfOneThatWasNot
  SiteJob.WithExactScansATrenchIsDugToItsDesign)
# Statistics of many scans.
set(thorough_trial_test
  SiteScan.ThePatternHasTheStatedDeviationAndIsSharedByNeighbours)
# Convergence over grids and a thousand digs.
set(thorough_calibration_test
  Validation.ConvergesWithTheGrid
  Validation.SolidsSurviveAThousandDigsOnRoughGround)
# A search killed a hundred times; resuming has a test of its own.
set(thorough_optimisation_test
  SearchCheckpointFile.KilledAtAHundredMomentsAndResumedGivesTheSameBytes)
# Libraries built and compared again; one shipped library of each goal stays.
set(thorough_planning_test
  StandingGround.NoPlanIsTrustedInTwoHundredScenesWithFewFalseAlarms
  PlanDig.OnUnevenGroundAnUncertainDensityIsSearchedAsThoroughlyAsAKnownOne
  LibraryBuilding.LooksUpWhatIsBestMidway
  LibraryBuilding.SeveralBuildsShareAFolder
  Calibration.SimulatorFreedOfFallbackGivesThePapersLine
  Soils/ShippedLibrary.HoldsNearlyTheBestDigs/1
  Soils/ShippedLibrary.HoldsNearlyTheBestDigs/2
  Soils/ShippedLibrary.HoldsNearlyTheBestDigs/3
  Soils/ShippedLibrary.HoldsNearlyTheBestDigs/4
  Soils/ShippedLibrary.HoldsNearlyTheBestDigs/6
  Soils/ShippedLibrary.HoldsNearlyTheBestDigs/7)
# Scenes of a site by the dozen; each check has a test of its own.
set(thorough_scans_test
  ScanChecks.NoBadSurveyIsTrustedAndWrong
  TwoStandpoints.ReturnsMixedFromOnePlaceAreLeftOutWhereTheOtherSees
  ScanSurface.AWallCountsByItsAreaNotByItsPoints
  ScanChecks.SwappedScansOfTwoAreasAreRefused
  ScanSurface.VolumeBetweenWallsStaysUnbiasedAtAnyHeadingAndDensity
  OneStandpoint.ShadowsAreFilledWithinTheirErrorWhereOnlyTheScanTellsItsPlace
  OneStandpoint.TellsItsPlaceByThePointsOnSlopes)
# Intervals over many soils and digs.
set(thorough_density_test
  Families.StrewnSoilIsInMostIntervals
  Families.OutliersNoDataAndFlatFloorsLoseTrustInThreeOfAHundredAtMost
  Families.ForeignThingsAreSeldomTrustedAndOutside
  RealPair.HalvesAgreeWithoutAnArea
  DensityByLoads.IntervalsHoldTheTruthInDigsOfTheOtherSimulator
  SoilAnswers.TheScatterOfALawIsThatOfDigsInLooseAndInDenseSoil
  SoilAnswers.AFallbackThatCannotBeIsNotUsed
  SoilAnswers.ALawForTheFieldPathReadsWhatTheDefaultLawDoesNot
  Successive.IntervalsHoldTheTruthAsOftenAsTheyState
  EstimateDensity.HalvesOfARealPairAgreeWithinTheirIntervals
  DensityByLoads.HarderSoilTakesMoreWorkAndSoilsScatter
  DensityByLoads.LoadsOfAnotherDigAreNotUsedAndEndTrust
  KnownGround/SurveysInARow.AreTrustedAndInsideInAllLayouts/*)
# Studies and field experiments, whose parts have tests of their own.
set(thorough_experiments_test
  FieldExperimentTest.RepeatsItselfForAnyNumberOfThreadsAndNotForAnotherSeed
  FieldExperimentTest.SoftSoilIsTrustedAndDugForLessFuel
  Study.GainsAreComparedWithThoseOfTheSameRunsOfTheFirstCondition
  Study.RunsThatAreNotComparedEstimateTheSame
  Study.ASurveyWithErrorsIsWorseThanOneWithout
  Study.TheOwnLawTellsTheDensityOfItsOwnSoil
  Study.APlanThatIsNotAdaptedIsTheSameForEachDensity
  Study.DigsInARowGoOnWhereTheLastEnded
  Study.ItIsTheSameForAnyThreadsAndRunsArePaired
  FieldExperimentTest.HardSoilInBlocksIsNotTrusted)
# Every option of the method on the same scans.
set(thorough_paper_test
  PaperVolumes.EveryOptionActs
  PaperVolumes.WallsAreCountedOnceInColumnsAndOftenInCubes)
# Searches and surveys with what is never right.
set(thorough_hostile_test
  UsersSimulator.OneThatAlwaysFailsEndsASearchWithinTwentyDigs
  HostileChange.LayersMayBeMissing)
# Whole calibrations, studies and libraries by a tool; the library's tests reach their code.
set(thorough_tools_test
  Tools.AStudyWritesItsRunsAndItsTable
  Tools.ASearchHasTheGenerationsOfItsHelpHoweverManyDigsItMayMake
  Tools.APathThatWasNotDugEndsTrust
  Tools.FieldExperimentComparesVolumePerFuel
  Tools.CalibrateDensityReportsTheDifferenceOfTrueAndMeasuredFactors
  Tools.APathWithoutItsStartChoosesTheLaw
  Tools.CalibrateDensityNamesTheSimulatorItDug
  Tools.CalibrateDensitySaysOnWhichDigsTheLawIs
  Tools.ShippedMachinesDig
  LibraryTool.OneOfTheRanksThatFailPrintsTheReason
  LibraryTool.SameBytesForOneToFourRanks
  Tools.FromAUrdfToAPlan
  Tools.ExperimentAlongThePathOfTheFieldTestHasALawForIt
  Tools.AKitOfAnotherMachineIsRefused
  Tools/HardSoilThatBreaks.*/1
  Tools/HardSoilThatBreaks.*/2
  Tools/HardSoilThatBreaks.*/3
  Tools/HardSoilThatBreaks.*/4
  FigureValues.ManyDensitiesCanBeReadOnAColumn
  Tools/EveryTool.QuietLeavesOnlyTheJson/machine_kit
  Tools/EveryTool.SaysThatItsOutputCannotBeWritten/machine_kit
  Tools/EveryTool.EndsQuietlyWhereNobodyReadsItsOutput/machine_kit)

# excavplan_discover_tests(PROGRAM): its tests by name, the thorough ones with their label, the others
# with that of their room.
function(excavplan_discover_tests program)
  string(REGEX REPLACE "_test$" "" room ${program})
  list(JOIN thorough_${program} ":" filter)
  if(NOT filter)
    gtest_discover_tests(${program} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS ${room})
    return()
  endif()
  gtest_discover_tests(${program} TEST_FILTER "-${filter}" DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS ${room})
  gtest_discover_tests(${program} TEST_FILTER "${filter}" DISCOVERY_TIMEOUT 60
    TEST_LIST ${program}_thorough PROPERTIES LABELS thorough)
endfunction()
